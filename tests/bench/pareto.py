#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws speed against error: what methods of finding motion cost, and how often they are right.

  tests/bench/pareto.sh FOLDER... [--lines N...] [--method NAME...] [--output FOLDER]

FOLDER is as for real_films.py, which says what is right, wrong and false. A method is one of `spidar-bench real_film`
(tests/bench/flow_methods.h), or those of METHODS: the element, and DIS, phase correlation and sparse Lucas-Kanade of OpenCV,
and the motion vectors of H.264, each with the same robust camera and the largest region. A learned dense flow is missing: no
package registry has the weights of one.

Which of twelve thresholds of that region a method has, of speed and of size, is chosen by the films that also chose the
constants of the element (`rest` in real_films/clips.tsv), as the one with the largest share of right frames less that of false
ones. All that is printed is of the other films. --lines scales all films to so many lines; then nothing is chosen, and all
have the first threshold.

Writes pareto.csv, the table that it prints as pareto.md, and pareto.svg by gnuplot. ms: processor time of a frame on
one thread without decoding. In brackets, and as bars: 95 % intervals over films (bootstrap)."""

import argparse
import csv
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from changed_films import LOSSLESS, height_of
from real_films import Tally, films_of, measure, print_head, read_truth
from shares import right_less_false, share, within

# One of each kind that takes no longer than a frame lasts at 60/s: at half the size, the element also as it is.
METHODS = ["object:1", "object:0.5", "vectors", "dis:ultrafast:0.5", "dis:medium:0.5", "phase:0.5", "lk:500"]
HAND_DEG = 18.4  # a turn of a force that a hand tells apart: Barbagli, Salisbury and others, 2006
# As flow_methods.cpp has them: px of a frame 480 lines high, cells of 16 px.
THRESHOLDS = [f"{px} px, {cells} cells" for px in (1, 2, 4) for cells in (3, 8, 24, 48)]
CLIPS = Path(__file__).with_name("real_films") / "clips.tsv"
KINDS = {"object": "motion=object", "paper": "motion=mean", "dis:ultrafast": "DIS, ultrafast",
         "dis:medium": "DIS, medium", "phase": "phase correlation", "lk": "sparse Lucas-Kanade", "vectors": "H.264 vectors"}


def scaled(film, truth, lines, folder):
    """The film with so many lines, and its truth."""
    factor = lines / height_of(film)
    made = Path(folder, "scaled.mkv")
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", film, "-an", "-vf", f"scale=-2:{lines}:flags=lanczos",
                    *LOSSLESS, made], check=True)
    return made, truth and {n: (factor * x, factor * y) for n, (x, y) in truth.items()}


def chose_constants():
    """Films, by clip or number, that may choose a threshold."""
    with open(CLIPS, encoding="utf-8", newline="") as file:
        return {row[name] for row in csv.DictReader(file, delimiter="\t") if row["split"] == "rest" for name in ("clip", "film")}


def less_false(tally):
    return right_less_false(tally.counts("right", "counted"), tally.counts("false", "without_object"))


def judge(program, method, films, lines):
    """The threshold that was chosen, and the tally of the films that did not choose it."""
    chosen, shown, rest = [Tally() for _ in THRESHOLDS], [Tally() for _ in THRESHOLDS], set() if lines else chose_constants()
    with tempfile.TemporaryDirectory() as folder:
        for film in films:
            name, truth = film.stem, read_truth(film)
            if lines:
                film, truth = scaled(film, truth, lines, folder)
            by_threshold, times_ms = measure(program, method, film)
            for tally, frames in zip(chosen if name in rest else shown, by_threshold):
                tally.add(frames, truth, times_ms)
    if not shown[0].films:
        sys.exit("pareto.py: all films chose thresholds (rest in real_films/clips.tsv): give others, too")
    if len(by_threshold) == 1:
        return "", shown[0]
    value = lambda n: float(less_false(chosen[n]).split()[0]) if less_false(chosen[n]) != "-" else 0
    best = max(range(len(THRESHOLDS)), key=value)
    return THRESHOLDS[best], shown[best]


def row(method, lines, threshold, tally):
    times = sorted(tally.times_ms)
    return [method, lines or "as they are", threshold, f"{statistics.median(times):.2f}", f"{times[len(times) * 99 // 100]:.2f}",
            share(tally.counts("right", "counted")), within(tally.apart, HAND_DEG, 2), share(tally.counts("wrong", "counted")),
            share(tally.counts("false", "without_object")), less_false(tally)]


COLUMNS = ["method", "lines", "threshold", "ms a frame", "99 %", "right %", f"within {HAND_DEG}° %", "wrong %", "false %",
           "right less false %"]


def draw(rows, output):
    """One point for each method with its interval and its size, and a line through those of one kind."""
    blocks = {}
    for method, lines, _, ms, *_, value in rows:
        kind = next(name for start, name in KINDS.items() if method.startswith(start))
        found = re.fullmatch(r"(\S+)(?: \((\S+) to (\S+)\))?", value)
        size = method.rpartition(":")[2] if ":" in method else ""
        middle = found[1]
        blocks.setdefault(kind, []).append((float(ms), middle, found[2] or middle, found[3] or middle,
                                            size if lines == "as they are" else f"{size} {lines}"))
    most_ms = 1.5 * max(ms for points in blocks.values() for ms, *_ in points)
    styles = [f"'-' using 1:2 with linespoints pt 7 lc {n} title '{kind}', '-' using 1:2:3:4 with yerrorbars pt 7 lc {n} notitle, "
              f"'-' using 1:2:5 with labels offset 1,0.7 font ',9' notitle" for n, kind in enumerate(blocks, 1)]
    script = (f'set terminal svg size 720,540 font "sans,12" background "white"; set output "{output / "pareto.svg"}"; '
              f'set logscale x; set xrange [:{most_ms}]; set yrange [-100:100]; set grid; set key bottom right; '
              'set title "Frames that are right, less those in which something is found where nothing moves"; '
              'set xlabel "processor time of a frame, ms (one thread)"; set ylabel "right less false, %"; plot '
              + ", ".join(styles) + "\n"
              + "".join(3 * ("".join(" ".join(map(str, point[:4])) + f' "{point[4]}"\n' for point in sorted(points)) + "e\n")
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
    if "no method" not in subprocess.run([program, "real_film", "?", "?"], check=False, stderr=subprocess.PIPE, text=True).stderr:
        sys.exit(f"pareto.py: {program} has no real_film: build it with -Dbenchmarks=enabled and libavformat-dev")
    options.output.mkdir(parents=True, exist_ok=True)
    rows = []
    print_head(*COLUMNS)
    for lines in options.lines:
        for method in options.method or METHODS:
            rows.append(row(method, lines, *judge(program, method, films, lines)))
            print("| " + " | ".join(map(str, rows[-1])) + " |", flush=True)
    (options.output / "pareto.md").write_text(
        "\n".join("| " + " | ".join(map(str, each)) + " |" for each in [COLUMNS, ["---"] * len(COLUMNS), *rows]) + "\n")
    with open(options.output / "pareto.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    draw(rows, options.output)


if __name__ == "__main__":
    main()
