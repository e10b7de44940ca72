#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares a figure for each topic with that of regression.json: regression.py BUILD. Fails when one is worse than the
file allows, and when one is better by more than that, because it is then to be written there.

Films: of a textured disc that goes round in front of a pan, and of the pan alone, which ffmpeg makes and codes without
loss and at crf 23 and 30, the share of frames in which the right motion is felt, and of those in which some is felt though
nothing moves but the camera, as real_films.py counts them. The others: bench_regression.cpp."""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from made_films import MADE_S, RATE, ffmpeg, make_films, x264
from real_films import Tally, play


def truth():
    """Of the disc that make_films() draws, against the pan: px of the film, which is reduced by 2, a frame."""
    def place(t):  # of the disc on the wall
        return (520 + 200 * math.sin(1.3 * t) + 200 + 150 * math.sin(0.9 * t + 0.3) + 60 * t,
                240 + 120 * math.cos(1.3 * t) + 150 + 40 * math.cos(0.7 * t))

    def moved(n):
        now, before = place(n / RATE), place((n - 1) / RATE)
        return tuple((a - b) / 2 for a, b in zip(now, before))

    return {n: moved(n) for n in range(1, MADE_S * RATE)}


def film_figures(build):
    tally = Tally()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for film, true in zip(make_films(folder), (truth(), None)):
            tally.add(play(build, film), true)
            for crf in (23, 30):
                coded = folder / f"{film.stem}-{crf}.mkv"
                ffmpeg("-i", film, *x264(crf), coded)
                tally.add(play(build, coded), true)
    return {"films_right_percent": 100 * tally.right / tally.counted,
            "films_false_percent": 100 * tally.false / tally.without_object}


def main():
    build = Path(sys.argv[1]).resolve()
    found = film_figures(build)
    lines = subprocess.run([build / "tests" / "bench" / "spidar-bench", "regression"], check=True,
                           stdout=subprocess.PIPE, text=True).stdout.splitlines()
    found.update((name, float(value)) for name, value in (line.split() for line in lines if line[0] != "("))
    file = Path(__file__).with_suffix(".json")
    expected = json.loads(file.read_text())
    bad = 0
    for name, value in found.items():
        figure, most = expected[name]["figure"], expected[name]["may_differ_by"]
        outside = abs(value - figure) > most
        bad += outside
        print(f"{name}: {value:.4g}, expected {figure} ± {most}{'   <- outside' if outside else ''}")
    if bad:
        sys.exit(f"regression.py: {bad} figures differ from those of {file}: mend what made them worse, or write there "
                 "what they are now, and say why in the commit")


main()
