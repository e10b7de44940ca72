#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Installs a build into a folder, moves that folder, and uses the installation. Only the variables are
set that any GStreamer plugin and any library outside the system's folders need.

check_installed.py SOURCE BUILD PREFIX LIBDIR PKGCONFIG BUS COMPILER...: PREFIX and LIBDIR are those of
the build; PKGCONFIG is `relocatable`, or `fixed` in a build folder that was set up without that option of
Meson, where pkg-config has to be told; BUS is the emulated USB, to be preloaded. The programs of examples/api are built with COMPILER against
what was installed, and run with the simulated device."""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROFILE = "only-in-the-moved-folder"
HEADERS = {"c-api.h", "device.h", "export.h", "gstspidarmotionmeta.h", "gstspidarobjectmeta.h", "motion.h", "picture.h", "wrench.h"}
MANUALS = ("spidar-feel.1", "spidarctl.1", "spidartrack.1")
META_PROGRAM = """
#include <gst-spidar/gstspidarmotionmeta.h>
int main (void) { GstBuffer *b = gst_buffer_new (); GstSpidarFrameMotion m;
  int found = gst_buffer_get_spidar_motion (b, &m); gst_buffer_unref (b); return found; }
"""


class Installed:
    """What was installed, after it was moved."""

    def __init__(self, source, folder, libdir):
        self.source, self.folder = source, folder
        self.libraries = folder / libdir
        self.plain = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("SPIDAR_", "GST_", "LD_", "PKG_CONFIG_"))
        }
        self.plain["GST_REGISTRY"] = str(folder.parent / "registry.bin")  # not the user's
        self.with_plugin = {**self.plain, "GST_PLUGIN_PATH": str(self.libraries / "gstreamer-1.0")}
        self.with_library = {**self.plain, "LD_LIBRARY_PATH": str(self.libraries)}

    def program(self, name):
        return str(self.folder / "bin" / name)


def run(command, env, fails=False):
    """What it says; ends the test when it does not end as expected."""
    done = subprocess.run(
        command, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100
    )
    line = " ".join(map(str, command))
    if (done.returncode != 0) != fails:
        sys.exit(f"error: {line}: exit status {done.returncode}\n{done.stdout}")
    print(f"ok: {line}")
    return done.stdout


def require(holds, what, said=""):
    if not holds:
        sys.exit(f"error: {what}\n{said}")


def check_told(it):
    """What is said after an installation, of a prefix that nothing searches, and of the system's own."""
    tell = lambda *arguments: run([str(it.source / "spidar/tell_installed.sh"), *arguments],
                                  {"PATH": "/usr/bin:/bin", "MESON_INSTALL_PREFIX": "/no/prefix"})
    said = tell("bin", "lib", "/no/prefix/python", "/usr/lib/gstreamer-1.0")
    for name, value in (("PATH", "bin"), ("GST_PLUGIN_PATH", "lib/gstreamer-1.0"), ("PYTHONPATH", "python"),
                        ("PKG_CONFIG_PATH", "lib/pkgconfig"), ("LD_LIBRARY_PATH", "lib")):
        require(f"export {name}=/no/prefix/{value}" in said, f"{name} is not told", said)
    said = tell("/usr/bin", "/usr/lib", "/usr/lib/python3/dist-packages", "/usr/lib/gstreamer-1.0")
    require("PATH=/usr/bin" not in said and "GST_PLUGIN_PATH" not in said, "what is found is told", said)


def install(build, prefix, into):
    with tempfile.TemporaryDirectory(dir=into) as staged:
        run(["meson", "install", "-C", str(build), "--no-rebuild", "--destdir", staged], os.environ)
        moved = into / "moved"
        (Path(staged) / prefix.relative_to("/")).rename(moved)
    return moved


def check_files(it):
    headers = {str(path.relative_to(it.folder / "include/gst-spidar")) for path in it.folder.glob("include/**/*.h")}
    require(headers == HEADERS, f"headers are installed that are not meant for others, or are missing: {headers ^ HEADERS}")
    for manual in MANUALS:
        require((it.folder / "share/man/man1" / manual).is_file(), f"no manual page {manual}")
    window = it.folder / "share/man/man1/spidar-window.1"
    built = any(it.folder.glob("libexec/**/spidar-window"))
    require(window.is_file() == built, "the manual page of spidar-window is not installed as the program is")
    for link in it.libraries.glob("**/*.so*"):
        said = run(["readelf", "-d", str(link)], it.plain)
        require("RPATH" not in said and "RUNPATH" not in said, f"{link} looks for libraries in a folder of the build", said)


def check_programs(it, relocatable, compiler):
    """The examples, built as their first lines say."""
    find = {**it.plain, "PKG_CONFIG_PATH": str(it.libraries / "pkgconfig")}
    told = [] if relocatable else [f"--define-variable=prefix={it.folder}"]
    flags = run(["pkg-config", *told, "--cflags", "--libs", "gst-spidar"], find).split()
    require(f"-I{it.folder}" in os.path.normpath(flags[0]), "pkg-config does not name the folder", " ".join(flags))
    built = {}
    for name in ("push", "pose", "picture"):
        built[name] = str(it.folder.parent / name)
        example = it.source / "examples" / "api" / f"{name}.cpp"
        require(len(example.read_text().splitlines()) <= 40, f"{example} has more than 40 lines")
        run([*compiler, "-std=c++17", "-Wall", "-Wextra", "-Werror", str(example), *flags, "-o", built[name]], it.plain)
    # 1 N is asked for, in every direction.
    strongest = float(re.search(r"sim: ([\d.]+) N", run([built["push"]], it.with_library)).group(1))
    require(0.5 < strongest <= 2, f"push: {strongest} N where 1 N was pushed")
    places = run([built["pose"]], it.with_library).split("\n")
    # The hand of the simulated device is at the centre; the grip is where it holds it, to 5 mm.
    numbers = [float(number) for place in places for number in place.split() if place != "not known"]
    require(len(numbers) == 30 and all(abs(mm) < 5 for mm in numbers), "pose: not at the centre", "\n".join(places))
    # 4 px in 40 ms are 100 px/s; the first pictures do not know yet what is background.
    last = run([built["picture"]], it.with_library).strip().split("\n")[-1]
    speed, force = map(float, re.findall(r"[\d.]+(?= px/s| N)", last))
    require(95 < speed < 105 and force > 0.8, "picture: does not move to the right by 100 px/s", last)
    built["push.c"] = str(it.folder.parent / "push_c")
    strict = ["-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror"]
    run(["cc", *strict, str(it.source / "examples/api/push.c"), *flags, "-o", built["push.c"]], it.plain)
    said = run([built["push.c"]], it.with_library)
    require(re.match(r"sim: [\d.]+ N", said), "push.c does not push", said)
    c_program = it.folder.parent / "meta.c"
    c_program.write_text(META_PROGRAM)
    gstreamer = run(["pkg-config", "--cflags", "--libs", "gstreamer-1.0"], it.plain).split()
    run(["cc", "-Werror", str(c_program), *flags[:1], *gstreamer, "-o", str(it.folder.parent / "meta")], it.plain)


def check_python(it):
    modules = list(it.folder.glob("**/gst_spidar/__init__.py"))
    require(len(modules) == 1, "the Python module is not installed once", str(modules))
    env = {**it.with_library, "PYTHONPATH": str(modules[0].parent.parent), "PYTHONDONTWRITEBYTECODE": "1"}
    said = run(["/usr/bin/python3", str(it.source / "examples/api/push.py")], env)
    require(re.match(r"sim: [\d.]+ N", said), "push.py does not push", said)
    said = run(["/usr/bin/python3", "-c", "import gst_spidar"], {**env, "LD_LIBRARY_PATH": ""}, fails=True)
    require("install libgst-spidar, or name its folder" in said, "a library that is missing is not named", said)


def check_plugin(it, bus):
    said = run(["gst-inspect-1.0", "spidarmotion"], it.with_plugin)
    require(str(it.libraries) in said, "gst-inspect-1.0 shows another plugin", said)
    profiles = it.folder / "share/gst-spidar/profiles"
    # The shipped ones are in the library, too: this one is found only in the folder.
    (profiles / f"{PROFILE}.toml").write_text((profiles / "spidar-g.toml").read_text())
    play = ["gst-launch-1.0", "-q", "videotestsrc", "num-buffers=10", "pattern=ball", "!", "spidarmotion"]
    run([*play, "device=sim", f"profile={PROFILE}", "!", "fakesink"], it.with_plugin)
    board = {**it.with_plugin, "LD_PRELOAD": bus, "SPIDAR_EMULATED_BUS": "sh4"}
    with_board = [*play, "device=usb", "profile=spidar-g6x3-v2-r", "on-device-error=error", "!", "fakesink"]
    run(with_board, board)
    guardian = next(it.folder.glob("*/**/spidar-guardian"))
    away = guardian.with_name("away")
    guardian.rename(away)
    said = run(with_board, board, fails=True)
    away.rename(guardian)
    require(f"{guardian}: No such file" in said, "the guardian is not looked for in the folder", said)


def check_tools(it):
    listed = run([it.program("spidarctl"), "list"], it.plain)
    require(PROFILE in listed, "spidarctl does not look for profiles in the folder", listed)
    require("usage: spidar-feel" in run([it.program("spidar-feel"), "--help"], it.plain), "no help")
    # Finds the plugin and the profile by itself, or could not check the properties.
    run([it.program("spidar-feel"), "max-force=2", f"profile={PROFILE}", "--", "true"], it.plain)
    run([it.program("spidartrack"), "--help"], it.plain)


def main():
    source, build, prefix = (Path(argument) for argument in sys.argv[1:4])
    libdir, relocatable, bus, compiler = sys.argv[4], sys.argv[5] == "relocatable", sys.argv[6], sys.argv[7:]
    with tempfile.TemporaryDirectory() as name:
        into = Path(name).resolve()
        it = Installed(source, install(build, prefix, into), libdir)
        check_files(it)
        check_programs(it, relocatable, compiler)
        if Path("/usr/bin/python3").exists():
            check_python(it)
        check_plugin(it, bus)
        check_tools(it)
        check_told(it)
    return 0


if __name__ == "__main__":
    sys.exit(main())
