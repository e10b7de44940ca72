#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws speed against error: what methods of finding motion cost, and how often they are right.

  tests/bench/pareto.sh FOLDER... [--lines N...] [--method NAME...] [--output FOLDER]

FOLDER is as for real_films.py, which says what is right, wrong and false. The methods are those of `spidar-bench
real_film` (tests/bench/flow_methods.h): the element at full, half and a quarter of the size, and its motion=mean; DIS,
Farnebäck, phase correlation and sparse Lucas-Kanade of OpenCV, and the motion vectors of H.264, each with the same robust
camera and the largest region. --lines scales the films to so many lines first. A learned dense flow is missing: no
package registry has the weights of one.

Writes pareto.csv, the table that it prints as pareto.md, and pareto.svg by gnuplot. ms: processor time of a frame on
one thread without decoding. In brackets: 95 % intervals over films."""

import argparse
import csv
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from changed_films import LOSSLESS, height_of
from real_films import Tally, films_of, measure, print_head, read_truth
from shares import mean_of_films, share, within

HAND_DEG = 18.4  # a turn of a force that a hand tells apart: Barbagli, Salisbury and others, 2006
KINDS = {"object": "motion=object", "paper": "motion=mean", "dis:ultrafast": "DIS, ultrafast", "dis:fast": "DIS, fast",
         "dis:medium": "DIS, medium", "farneback": "Farnebäck", "phase": "phase correlation",
         "lk": "sparse Lucas-Kanade", "vectors": "H.264 vectors"}


def method_names(program):
    """Those that the program names in its error."""
    listed = subprocess.run([program, "real_film", "?", "?"], check=False, stderr=subprocess.PIPE, text=True).stderr
    if "no method" not in listed:
        sys.exit(f"pareto.py: {program} has no real_film: build it with -Dbenchmarks=enabled and libavformat-dev")
    return ["paper", *(f"object:{size}" for size in ("1", "0.5", "0.25")),
            *(f"dis:{preset}:{size}" for preset in ("ultrafast", "fast", "medium") for size in ("1", "0.5", "0.25")),
            *(f"{kind}:{size}" for kind in ("farneback", "phase") for size in ("1", "0.5", "0.25")),
            *(f"lk:{points}" for points in (100, 500, 2000)), "vectors"]


def scaled(film, truth, lines, folder):
    """The film with so many lines, and its truth."""
    factor = lines / height_of(film)
    made = Path(folder, "scaled.mkv")
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", film, "-an", "-vf", f"scale=-2:{lines}:flags=lanczos",
                    *LOSSLESS, made], check=True)
    return made, truth and {n: (factor * x, factor * y) for n, (x, y) in truth.items()}


def judge(program, method, films, lines):
    tally = Tally()
    with tempfile.TemporaryDirectory() as folder:
        for film in films:
            truth = read_truth(film)
            if lines:
                film, truth = scaled(film, truth, lines, folder)
            frames, times_ms = measure(program, method, film)
            tally.add(frames, truth, times_ms)
    return tally


def row(method, lines, tally):
    of = lambda part, whole="counted": share([(film.get(part, 0), film[whole]) for film in tally.films])
    times = sorted(tally.times_ms)
    return [method, lines or "as they are", f"{statistics.median(times):.2f}", f"{times[len(times) * 99 // 100]:.2f}",
            f"{1000 / statistics.median(times):.0f}", of("right"), within(tally.apart, HAND_DEG, 2),
            mean_of_films([(film.get("right", 0), film["counted"]) for film in tally.films]), of("wrong"),
            of("false", "without_object")]


COLUMNS = ["method", "lines", "ms a frame", "99 %", "frames/s", "right %", f"within {HAND_DEG}° %",
           "mean of films, below half", "wrong %", "false %"]


def draw(rows, output):
    """One point for each method, and a line through those of one kind."""
    blocks = {}
    for method, lines, ms, _, _, right, *_ in rows:
        kind = next(name for start, name in KINDS.items() if method.startswith(start))
        blocks.setdefault(kind, []).append((float(ms), right.split()[0], f"{method} {lines}"))
    most_ms = 1.5 * max(ms for points in blocks.values() for ms, _, _ in points)
    script = (f'set terminal svg size 720,480 font "sans,12" background "white"; set output "{output / "pareto.svg"}"; '
              f'set logscale x; set xrange [:{most_ms}]; set yrange [0:100]; set grid; set key bottom right; '
              'set xlabel "processor time of a frame, ms (one thread)"; set ylabel "right, % of frames"; plot '
              + ", ".join(f'"-" using 1:2 with linespoints pt 7 title "{kind}"' for kind in blocks) + "\n"
              + "".join("".join(f"{ms} {right}\n" for ms, right, _ in sorted(points)) + "e\n"
                        for points in blocks.values()))
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--lines", nargs="+", type=int, default=[0])
    parser.add_argument("--method", nargs="+")
    parser.add_argument("--output", type=Path, default=Path("."))
    options = parser.parse_args()
    program = Path(os.environ.get("BUILD", "build")).resolve() / "tests" / "bench" / "spidar-bench"
    films = films_of(options.folders)
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    print_head(*COLUMNS)
    for lines in options.lines:
        for method in options.method or method_names(program):
            rows.append(row(method, lines, judge(program, method, films, lines)))
            print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)
    (options.output / "pareto.md").write_text(
        "\n".join("| " + " | ".join(map(str, each)) + " |" for each in [COLUMNS, ["---"] * len(COLUMNS), *rows]) + "\n")
    with open(options.output / "pareto.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    draw(rows, options.output)


if __name__ == "__main__":
    main()
