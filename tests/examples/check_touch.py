#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Checks that the touched relief is that of the picture: check_touch.py PROGRAM"""
import csv
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

RELIEF_MM = 8
STIFFNESS_N_MM = 0.5


def write_png(path, width, height, luma):
    """Grey, 8 bits; luma(x, y) is 0 to 255."""
    rows = b"".join(b"\0" + bytes(luma(x, y) for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" +
                   chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def rows_of(path):
    with open(path) as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def check_slope(program, folder):
    """Black on the left and white on the right, and between them a slope of 20 degrees."""
    image = os.path.join(folder, "slope.png")
    write_png(image, 320, 240, lambda x, y: min(max((x - 100) * 255 // 120, 0), 255))
    done = subprocess.run([program, image, "--output", folder], text=True, capture_output=True,
                          timeout=60)
    assert done.returncode == 0, done
    assert "in contact" in done.stdout and "touch.png" in done.stdout, done.stdout
    assert os.path.getsize(os.path.join(folder, "touch.png")) > 10_000
    ticks = rows_of(os.path.join(folder, "touch-ticks.csv"))
    for side, height_mm in (-1, -RELIEF_MM / 2), (1, RELIEF_MM / 2):
        # Where it strokes, four millimetres or more beside the slope.
        there = [row for row in ticks
                 if row["time_s"] > 1 and side * row["grip_x_mm"] > 15 and row["force_z_N"] > 0.1]
        assert len(there) > 300, len(there)
        # A sample of brightness, and floats.
        assert abs(mean(row["surface_z_mm"] for row in there) - height_mm) < RELIEF_MM / 255, side
        # On level ground the force is stiffness times depth. The grip moves across at 12 mm/s, which
        # costs up to its way in 3.5 ms of depth, and climbs nothing.
        depth_mm = mean(row["surface_z_mm"] - row["grip_z_mm"] for row in there)
        force_N = mean(row["force_z_N"] for row in there)
        assert abs(force_N / (STIFFNESS_N_MM * depth_mm) - 1) < 0.05, (side, force_N, depth_mm)


def check_names(program, folder):
    """gnuplot takes a file name that begins with | or < for a command."""
    image = os.path.join(folder, "slope.png")
    for name in ["|touch ran; true ", "<touch ran; true ", "it's", "`touch ran`", "two\nlines"]:
        done = subprocess.run([program, image, "--output", name], text=True, capture_output=True,
                              timeout=60, cwd=folder)
        assert done.returncode == 0, (name, done)
        assert not os.path.exists(os.path.join(folder, "ran")), name
        assert os.path.getsize(os.path.join(folder, name, "touch.png")) > 10_000, name


def check_own_picture(program, folder):
    """A picture that is called as the drawing is no drawing of this program."""
    image = os.path.join(folder, "own", "touch.png")
    os.mkdir(os.path.dirname(image))
    shutil.copy(os.path.join(folder, "slope.png"), image)
    for read in image, os.path.join(folder, "slope.png"):
        done = subprocess.run([program, read, "--output", os.path.dirname(image)], text=True, capture_output=True, timeout=60)
        assert done.returncode == 1 and "touch.png: " in done.stderr, done
        with open(image, "rb") as kept, open(os.path.join(folder, "slope.png"), "rb") as before:
            assert kept.read() == before.read()


def check_mistakes(program, folder):
    none = os.path.join(folder, "none.png")
    text = os.path.join(folder, "text.png")
    with open(text, "w") as file:
        file.write("no picture\n" * 100)
    for arguments, status, reason in [([], 2, "IMAGE"), (["a", "b"], 2, "not expected: b"),
                                      (["--output"], 2, "--output"), ([none], 1, none),
                                      ([text], 1, "text"), ([none, "--output", "/dev/null/x"], 1,
                                                            "/dev/null/x")]:
        done = subprocess.run([program, *arguments], text=True, capture_output=True, timeout=60)
        assert done.returncode == status and reason in done.stderr, (arguments, done)


def main():
    if shutil.which("gnuplot") is None:
        print("skipped: gnuplot is not installed", file=sys.stderr)
        sys.exit(77)
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        check_slope(program, folder)
        check_names(program, folder)
        check_own_picture(program, folder)
        check_mistakes(program, folder)


if __name__ == "__main__":
    main()
