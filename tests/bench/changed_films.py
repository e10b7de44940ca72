#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures what becomes of real_films.py when the same films are changed a little, or made worse:

  tests/bench/changed_films.py FOLDER...       with the spidarmotion of build/, or $BUILD

FOLDER is that of real_films.py. slight: the films mirrored, and cut by six pixels at the left and the top, which changes
nothing that a viewer would notice. worse: at 240 lines, blurred, with noise, at a quarter of the contrast, and coded with
a large loss. In brackets, 95 % intervals over films; all changes of a film are one, as they resemble each other.
Needs ffmpeg."""

import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from real_films import Tally, films_of, play, print_head, read_truth
from shares import share

LOSSLESS = ["-c:v", "ffv1"]
LINES = 240
# By name: ffmpeg's filter, coding, and what becomes of the truth.
SAME, MIRRORED = (lambda motion, height: motion), (lambda motion, height: (-motion[0], motion[1]))
SCALED = lambda motion, height: tuple(LINES / height * each for each in motion)
CHANGES = {
    "slight": {"mirrored": ("hflip", LOSSLESS, MIRRORED), "cut": ("crop=iw-6:ih-6:6:6:exact=1", LOSSLESS, SAME)},
    "worse": {"240 lines": (f"scale=-2:{LINES}:flags=area", LOSSLESS, SCALED),
              "blurred, σ = 2 px": ("gblur=2", LOSSLESS, SAME),
              # Its strength is √3 standard deviations (libavfilter/vf_noise.c): 6 grey levels.
              "noise of 6 grey levels": ("noise=c0s=10:c0f=t:all_seed=1", LOSSLESS, SAME),
              "a quarter of the contrast": ("eq=contrast=0.25", LOSSLESS, SAME),
              "H.264, crf 34": ("null", ["-c:v", "libx264", "-crf", "34", "-pix_fmt", "yuv420p"], SAME)},
}


def height_of(film):
    shown = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=height", "-of",
                            "csv=p=0", film], check=True, stdout=subprocess.PIPE, text=True).stdout
    return int(shown.split()[0])


def judge(build, film, change):
    """What was right and wrong in the changed film."""
    filters, coding, moved = change
    truth, height, tally = read_truth(film), height_of(film), Tally()
    if truth is not None:
        truth = {n: moved(motion, height) for n, motion in truth.items()}
    with tempfile.TemporaryDirectory() as folder:
        changed = Path(folder, "changed.mkv")
        subprocess.run(["ffmpeg", "-loglevel", "error", "-i", film, "-an", "-vf", filters, *coding, changed], check=True)
        tally.add(play(build, changed), truth)
    return tally.sums()


def row(name, films):
    of = lambda part, whole="counted": share([(film[part], film[whole]) for film in films])
    return f"| {name} | {of('right')} | {of('wrong')} | {of('false', 'without_object')} |"


def main():
    build = Path(os.environ.get("BUILD", "build")).resolve()
    films = films_of([Path(folder) for folder in sys.argv[1:]] or sys.exit("usage: tests/bench/changed_films.py FOLDER..."))
    print_head("", "right %", "wrong %", "false %")
    for kind, changes in CHANGES.items():
        all_of_kind = [Counter() for _ in films]
        for name, change in changes.items():
            sums = [judge(build, film, change) for film in films]
            print(row(name, sums), flush=True)
            for total, each in zip(all_of_kind, sums):
                total.update(each)
        print(row(f"all {kind}", all_of_kind), flush=True)


if __name__ == "__main__":
    main()
