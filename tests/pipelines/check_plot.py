#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Checks pictures of haptic tracks, for all sizes of force and torque: check_plot.py SPIDARTRACK

Numbers of any length at an axis leave room for its label, and a track in which nothing is felt has a picture, too,
without a word of gnuplot's.
"""
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import wave

# Full scale of force and torque is 32767; the numbers at the axes have two to seven characters.
SIZES = [(0, 0), (1, 1), (3, 30), (10, 3), (100, 2), (3000, 300), (5, 1000), (30000, 30000)]
EDGE_PX = 3  # nothing is drawn so near to the edge


def save_track(path, force, torque):
    amplitudes = [force] * 3 + [torque] * 3
    with wave.open(path, "wb") as file:
        file.setnchannels(6)
        file.setsampwidth(2)
        file.setframerate(1000)
        file.writeframes(b"".join(
            struct.pack("<6h", *(round(size * math.sin(i / 100 + axis)) for axis, size in enumerate(amplitudes)))
            for i in range(2000)))


def darkest_at_left_edge(png):
    command = ["ffmpeg", "-v", "error", "-i", png, "-vf", f"crop={EDGE_PX}:ih:0:0", "-f", "rawvideo", "-pix_fmt", "gray",
               "-"]
    return min(subprocess.run(command, capture_output=True, check=True).stdout)


def main():
    for program in "gnuplot", "ffmpeg":
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed", file=sys.stderr)
            sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        track, png = os.path.join(folder, "track.wav"), os.path.join(folder, "track.png")
        for force, torque in SIZES:
            save_track(track, force, torque)
            done = subprocess.run([sys.argv[1], "plot", track, png], text=True, capture_output=True, timeout=60)
            assert done.returncode == 0 and not done.stderr, (force, torque, done)
            assert darkest_at_left_edge(png) == 255, f"a label is cropped with {force} and {torque}"


if __name__ == "__main__":
    main()
