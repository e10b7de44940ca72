#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Checks that programs say how they are used, and do nothing else: check_help.py PROGRAM..."""
import os
import subprocess
import sys
import tempfile


def main():
    with tempfile.TemporaryDirectory() as folder:
        for program in map(os.path.abspath, sys.argv[1:]):
            command = [sys.executable, program] if program.endswith(".py") else [program]
            done = subprocess.run([*command, "--help"], stdin=subprocess.DEVNULL, text=True, capture_output=True,
                                  cwd=folder, timeout=60)
            assert done.returncode == 0, (program, done)
            assert done.stdout.startswith("usage: ") and not done.stderr, (program, done)
            wrong = subprocess.run([*command, "--bogus"], stdin=subprocess.DEVNULL, text=True, capture_output=True,
                                   cwd=folder, timeout=60)
            assert wrong.returncode == 2 and "usage: " in wrong.stderr, (program, wrong)
            assert not os.listdir(folder), (program, os.listdir(folder))


if __name__ == "__main__":
    main()
