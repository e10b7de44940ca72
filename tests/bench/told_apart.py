#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints how much of the motion in films a hand can tell apart, for each controller:

  tests/bench/told_apart.py FOLDER...        with the spidarmotion of build/, or $BUILD

FOLDER holds films, as for real_films.py. Counted are the frames in which something is felt to move (real_films.py), and
of films with at least MOVING_S of them.

steps: just noticeable steps of force between the 5 % and the 95 % quantile of a film's frames, ln(F95 / F05) /
ln(1 + WEBER), where less than FELT_N counts as FELT_N: the median over the films, and over the frames of all films
together. too weak: the share of these frames with less force than a hand feels. near the limit: the share with more
than nine tenths of max-force. median: of the force, N. Calm as in real_films.py."""

import math
import os
import statistics
import sys
from pathlib import Path

from real_films import FELT_N, Tally, films_of, play

WEBER = 0.11  # of force, at the wrist: IEEE Trans. Haptics 2013, PubMed 24808327
MOVING_S = 1
ALPHAS_S_PX = (0.00125, 0.0025, 0.005, 0.01)
MAX_FORCE_N = 3  # steps do not depend on it, but for what is weaker than FELT_N
# Properties, but for alpha, which `linear` does not have.
SETTINGS = [("controller=linear", 0)] + [(f"controller={controller}", alpha) for controller in ("nonlinear", "adaptive")
                                         for alpha in ALPHAS_S_PX] + [("motion=mean", alpha) for alpha in (0.0025, 0.01)]


def steps(forces_N):
    low, high = (max(FELT_N, quantile) for quantile in
                 (statistics.quantiles(forces_N, n=20)[i] for i in (0, -1)))
    return math.log(high / low) / math.log1p(WEBER)


def main():
    build = Path(os.environ.get("BUILD", "build")).resolve()
    films = films_of([Path(folder) for folder in sys.argv[1:]] or sys.exit("usage: tests/bench/told_apart.py FOLDER..."))
    print("| properties | alpha, s/px | steps in a film | in all films | too weak % | near the limit % "
          "| median, N | changes, turns, starts a minute |\n" + "|---" * 8 + "|")
    for setting, alpha in SETTINGS:
        tally, each_film, all_N = Tally(), [], []
        for film in films:
            frames = play(build, film, [setting, f"max-force={MAX_FORCE_N}"] + [f"alpha={alpha}"] * (alpha > 0))
            tally.add_calm(frames)
            moving = [frame for frame in frames if frame.is_felt]
            if sum(frame.seconds for frame in moving) < MOVING_S:
                continue
            forces_N = [math.hypot(*frame.force_N) for frame in moving]
            each_film.append(steps(forces_N))
            all_N += forces_N
        share = lambda of: f"{100 * sum(map(of, all_N)) / len(all_N):.0f}"
        calm = ", ".join(f"{60 * n / tally.seconds:.1f}" for n in (tally.changes, tally.turns, tally.starts))
        print(f"| {setting} | {alpha or '-'} | {statistics.median(each_film):.1f} "
              f"| {steps(all_N):.1f} | {share(lambda f: f < FELT_N)} | {share(lambda f: f > 0.9 * MAX_FORCE_N)} "
              f"| {statistics.median(all_N):.2f} | {calm} |", flush=True)


if __name__ == "__main__":
    main()
