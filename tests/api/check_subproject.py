#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Checks that another Meson project can contain this one: check_subproject.py SOURCE PROGRAM.c setup|build

The project in C has no dependency but those that its subproject offers: the library for push.c of examples/api/, and
the plugin as a part of PROGRAM.c. `build` also builds and runs both.
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = """project('contains-gst-spidar', 'c', version: '1', meson_version: '>= 1.0', default_options: ['c_std=c11'])
executable('push', 'push.c', dependencies: dependency('gst-spidar'))
executable('static', 'static.c', dependencies: [dependency('gstspidar'), dependency('gstreamer-1.0')])
"""
WRAP = """[wrap-file]
directory = gst-spidar

[provide]
dependency_names = gst-spidar, gstspidar
"""


def main():
    source, program, how = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "subprojects").mkdir()
        (folder / "meson.build").write_text(PROJECT)
        (folder / "subprojects/gst-spidar.wrap").write_text(WRAP)
        (folder / "subprojects/gst-spidar").symlink_to(source)
        (folder / "push.c").symlink_to(source / "examples/api/push.c")
        (folder / "static.c").symlink_to(program)
        # A library that is installed must not take its place.
        env = os.environ | {"PKG_CONFIG_PATH": "", "SPIDAR_PROFILE_PATH": str(source / "spidar/profiles/shipped")}
        subprocess.run(["meson", "setup", folder / "build", folder, "--force-fallback-for=gst-spidar,gstspidar",
                        "-Dunity=subprojects"], check=True, env=env)
        if how != "build":
            return
        subprocess.run(["ninja", "-C", folder / "build", "push", "static"], check=True, env=env)
        said = subprocess.run([folder / "build/push"], check=True, env=env, text=True, capture_output=True).stdout
        assert "N at most" in said, said
        subprocess.run([folder / "build/static"], check=True, env=env)


if __name__ == "__main__":
    main()
