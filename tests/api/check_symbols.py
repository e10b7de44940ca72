#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares the symbols that libgst-spidar exports with the recorded list.

check_symbols.py LIBRARY LIST            says what was removed or added, and what to do about it
check_symbols.py LIBRARY LIST --write    writes the list

The names are those of 64-bit Linux; elsewhere the test is skipped."""

import struct
import subprocess
import sys
from pathlib import Path

SKIPPED = 77
HEAD = """# Symbols that libgst-spidar.so exports on 64-bit Linux, with their versions. Written by
#   tests/api/check_symbols.py build/spidar/api/libgst-spidar.so spidar/api/symbols.txt --write
"""
REMOVED = """removed, or its parameters were changed:
{names}
  A program that was built with this interface no longer runs. Put the symbol back (the old one may
  call the new one), or begin a new interface: raise api_soversion in spidar/api/meson.build, rename the
  namespace v0 and the version GST_SPIDAR_0 in spidar/api/export.map, rename debian/libgst-spidar0*, and say
  so in CHANGELOG.md. Then write the list."""
ADDED = """added:
{names}
  If it is meant for other programs, document it in spidar/api/include/ and write the list:
    tests/api/check_symbols.py {library} {list} --write
  and, once a version has been released, state the version that added it in
  debian/libgst-spidar0.symbols. If it is not meant for them, move it out of the namespace
  gst_spidar."""


def exported(library):
    listed = subprocess.run(
        ["nm", "--dynamic", "--defined-only", "--format=posix", library], check=True, capture_output=True, text=True
    )
    return sorted(line.split()[0] for line in listed.stdout.splitlines())


def kept(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line.split()[0] for line in lines if line and not line.startswith("#")]


def readable(names):
    if not names:
        return []
    # c++filt leaves what follows the version as it is.
    plain = "\n".join(name.split("@")[0] for name in names)
    said = subprocess.run(["c++filt"], input=plain, check=True, capture_output=True, text=True).stdout
    return said.splitlines()


def indented(names):
    return "\n".join(f"    {name}  {text}" for name, text in zip(names, readable(names)))


def main():
    library, path = sys.argv[1], Path(sys.argv[2])
    if struct.calcsize("P") != 8:
        print("skipped: the list is that of 64-bit machines")
        return SKIPPED
    now = exported(library)
    if sys.argv[3:] == ["--write"]:
        lines = [f"{name}  # {text}" for name, text in zip(now, readable(now))]
        path.write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8")
        return 0
    before = kept(path)
    removed = [name for name in before if name not in now]
    added = [name for name in now if name not in before]
    if removed:
        print(REMOVED.format(names=indented(removed)))
    if added:
        print(ADDED.format(names=indented(added), library=library, list=path))
    print(f"{len(now)} symbols: {len(removed)} removed, {len(added)} added")
    return 1 if removed or added or not now else 0


if __name__ == "__main__":
    sys.exit(main())
