#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""check_executed.py BUILD, after the tests there have run: prints the sources of which they execute no function, and
fails when there is one that EXCUSED does not name. BUILD/executed/ is written by tests/support/executed.cpp."""

import subprocess
import sys
from array import array
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
LAYERS = ("core", "plugin", "spidar")

# Sources of which no test executes a function in the build of CI with the address sanitizer, and why.
INLINED = "has only functions that Clang puts into devices(), which is executed"
EXCUSED = {
    "spidar/devices/sound/missing_alsa.cpp": "ALSA is in this build",
    "spidar/devices/usb_kinds.cpp": INLINED,
    "spidar/transports/missing_websockets.cpp": "libwebsockets is in this build",
}


def executed(words):
    """The sources that belong to the offsets of executed instructions, of one program or library."""
    program = Path(words.name.replace("!", "/"))
    if not program.exists():  # a copy, which a test has removed
        return
    offsets = "".join(f"{word:#x}\n" for word in array("Q", words.read_bytes()) if word)
    found = subprocess.run(["addr2line", "-f", "-e", program], input=offsets, check=True, stdout=subprocess.PIPE,
                           text=True).stdout.splitlines()
    for function, place in zip(found[::2], found[1::2]):
        # Constants are set up in each program, whatever it tests.
        if not function.startswith(("__cxx_global_var_init", "_GLOBAL__sub_I")):
            yield Path(place.rpartition(":")[0]).resolve()


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_executed.py BUILD")
    programs = list((Path(sys.argv[1]) / "executed").iterdir())
    if not programs:
        sys.exit(f"error: {sys.argv[1]}/executed/ is empty; run the tests there first")
    sources = {source for layer in LAYERS for source in (TOP / layer).rglob("*.cpp")}
    never = sources.difference(*map(executed, programs))
    names = {str(source.relative_to(TOP)) for source in never}
    faults = [f"no test executes {name}" for name in sorted(names - set(EXCUSED))]
    faults += [f"there is no {name}, which is excused here" for name in EXCUSED if not (TOP / name).exists()]
    print(f"{len(sources) - len(names)} of {len(sources)} sources are executed by a test")
    print(*(f"  {name}: {EXCUSED[name]}" for name in sorted(names & set(EXCUSED))), *faults, sep="\n")
    sys.exit(1 if faults else 0)


main()
