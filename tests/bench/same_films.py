#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures whether a film is felt the same when it is changed so that it shows the same motion; needs no truth:

  tests/bench/same_films.py FOLDER...       with the spidarmotion of build/, or $BUILD

Films are mirrored, lose two columns at the left, or four fifths of their contrast are left. Of the frames in which a
force of the film is felt (0.04 N): alike, within 30 degrees of what the change makes of that force; beyond 60 degrees; and
not felt. new: felt in the changed film, of the frames in which the film is not. In brackets, 95 % intervals over films.
Then the films that are felt alike least, of those that are felt in eight frames or more. Needs ffmpeg."""

import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from changed_films import LOSSLESS
from real_films import FELT_N, films_of, play, print_head
from shares import share

# ffmpeg's filter, and the sign of x. Luma is coded without loss, so that nothing else differs.
GUISES = {"mirrored": ("hflip", -1), "two columns less": ("crop=iw-2:ih:2:0:exact=1", 1),
          "paler": ("lutyuv=y=128+(val-128)*0.8", 1)}
LEAST_FELT = 8
WORST = 5


def forces(build, film, filters):
    with tempfile.TemporaryDirectory() as folder:
        changed = Path(folder, "changed.mkv")
        subprocess.run(["ffmpeg", "-loglevel", "error", "-i", film, "-an", "-vf", filters, *LOSSLESS, "-pix_fmt", "yuv420p",
                        changed], check=True)
        return [frame.force_N[:2] for frame in play(build, changed)]


def compare(film, changed, sign):
    """Numbers of frames: felt, alike, beyond 60 degrees, not felt; not felt in the film, and of these felt when changed."""
    sums = [0] * 6
    for (x, y), other in zip(film, changed):
        also = math.hypot(*other) >= FELT_N
        if math.hypot(x, y) < FELT_N:
            sums[4] += 1
            sums[5] += also
            continue
        x *= sign
        apart = abs(math.degrees(math.atan2(x * other[1] - y * other[0], x * other[0] + y * other[1])))
        for n, holds in enumerate((True, also and apart <= 30, also and apart > 60, not also)):
            sums[n] += holds
    return sums


def main():
    build = Path(os.environ.get("BUILD", "build")).resolve()
    films = films_of([Path(folder) for folder in sys.argv[1:]] or sys.exit("usage: tests/bench/same_films.py FOLDER..."))
    as_they_are = [forces(build, film, "null") for film in films]
    print_head("", "alike %", "beyond 60° %", "not felt %", "new %", "least alike %")
    for name, (filters, sign) in GUISES.items():
        sums = [compare(felt, forces(build, film, filters), sign) for film, felt in zip(films, as_they_are)]
        of = lambda part, whole: share([(each[part], each[whole]) for each in sums])
        least = sorted((100 * each[1] / each[0], film.stem) for film, each in zip(films, sums) if each[0] >= LEAST_FELT)
        print(f"| {name} | {of(1, 0)} | {of(2, 0)} | {of(3, 0)} | {of(5, 4)} | "
              f"{', '.join(f'{film} {alike:.0f}' for alike, film in least[:WORST])} |", flush=True)


if __name__ == "__main__":
    main()
