#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures whether the right motion is felt in real films. real_films.py BUILD FOLDER [OLDER_BUILD] runs the
spidarmotion of a meson build folder on the films of FOLDER and prints four tables: how
often each model of the camera's motion is chosen; a row for each of its settings, and one for OLDER_BUILD, the
build folder of an older version; films of which a corner is cut off; methods with the processor time that each
takes, see bench_real_film.cpp.
real_films.py BUILD --calm FILM... prints how calm the force is in films of which no truth is known.

FOLDER holds films that GStreamer can decode. Beside a film, NAME.csv gives the true motion of its
object against the background: lines `frame,x,y`, the first frame being 0, in pixels of the film
since the frame before, x right, y down; frames that are missing are not counted. A film without
such a file has no object, only a camera that moves. truth.py makes such a FOLDER from a data set.

right: within 30 degrees and a factor of 2 of the truth. wrong: felt and more than 60 degrees off.
Counted are frames with more than 1 px of true motion, of a frame 480 lines high. false: frames of
films without an object in which some motion is felt. jitter: root mean square of the second
difference of the motion, px of a frame 480 lines high, median over the films, beside that of the
truth. felt: more than 2.1 px/s of a frame 480 lines high.

changes: times a minute that another object is felt. turns: times a minute that the force turns by more
than 90 degrees from one frame to the next. step: root mean square of its change from frame to frame, N.
felt: share of the frames with a force of at least 0.04 N, the least that a hand feels. run: mean time in
which the same object is felt."""

import csv
import json
import math
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

REFERENCE_LINES = 480
FELT_PX_S = 2.1
LEAST_TRUE_PX = 1.0
FELT_N = 0.04
FRAMES_A_SECOND = 24  # what FELT_PX_S is a speed of where times are not known
SETTINGS = [
    [],
    ["motion=mean"],
    ["motion=mean", "filter-min-cutoff=0"],
]
NAMES = {"motion=mean filter-min-cutoff=0": "closest to the paper"}
# Of bench_real_film, and their names in the table.
METHODS = {
    "default": "`motion=object`",
    "paper": "closest to the paper",
    "dis": "DIS at half size, largest region",
    "vectors": "H.264 vectors, largest region",
}


class Table:
    """A heading, and rows that are printed as they come."""

    def __init__(self, name, *columns):
        print(f"\n## {name}\n")
        self.add("| " + " | ".join(columns) + " |")
        self.add("|---" * len(columns) + "|")

    def add(self, line):
        print(line, flush=True)


def read_truth(file):
    """Motion by frame, px."""
    with open(file, newline="") as lines:
        return {int(n): (float(x), float(y)) for n, x, y in csv.reader(lines)}


def analyse(build, film, properties, crop=()):
    """What is found in each frame, see docs/elements.md; `crop` are elements before spidarmotion."""
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder) / "trace.jsonl"
        environment = dict(
            os.environ,
            GST_PLUGIN_PATH=str(build / "plugin"),
            GST_REGISTRY=str(build / "real_films.registry"),
        )
        environment.setdefault("SPIDAR_PROFILE_PATH", "spidar/profiles/shipped")
        subprocess.run(
            ["gst-launch-1.0", "-q", "filesrc", f"location={film}", "!", "decodebin", "!",
             *crop, "spidarmotion", "device=none", "post-messages=false", f"trace={trace}", *properties,
             "!", "fakesink", "sync=false"],
            env=environment, check=True, stdout=subprocess.DEVNULL)
        return [json.loads(line) for line in trace.read_text().splitlines()]


def play(build, film, properties, crop=()):
    """Motion of each frame in px since the frame before, the seconds since then, the height."""
    rows = analyse(build, film, properties, crop)
    motion = []
    for row in rows:
        seconds = row["interval_ns"] * 1e-9
        motion.append(tuple(v * seconds for v in row["motion"]["velocity_px_s"]))
    return motion, [row["interval_ns"] * 1e-9 for row in rows], rows[0]["height_px"]


def corners():
    """Where an eighth of each side is cut off, which moves the object out of the middle."""
    for x in ("left", "right"):
        for y in ("top", "bottom"):
            yield f"{y} {x}", x, y


def size_px(film):
    """Width and height of a film."""
    lines = subprocess.run(["gst-discoverer-1.0", "-v", film], check=True, stdout=subprocess.PIPE,
                           text=True).stdout
    return tuple(int(re.search(rf"{side}: (\d+)", lines)[1]) for side in ("Width", "Height"))


def compare_corners(build, films):
    table = Table("A corner cut off", "cut off", "right %", "wrong %", "any force %", "false %", "jitter (true)")
    together = Tally()
    for name, x, y in corners():
        tally = Tally()
        for film in films:
            width, height = size_px(film)
            crop = ["videocrop", f"{x}={width // 16 * 2}", f"{y}={height // 16 * 2}", "!"]
            found = play(build, film, [], crop)
            truth = film.with_suffix(".csv")
            for each in (tally, together):
                each.add(*found, read_truth(truth) if truth.exists() else None)
        table.add(tally.row(name))
    table.add(together.row("all four"))


def jitter(motion, frames):
    """Of the frames whose two predecessors are also known."""
    squares = []
    for n in frames:
        if n - 1 in frames and n - 2 in frames:
            a, b, c = motion[n], motion[n - 1], motion[n - 2]
            squares.append(sum((p - 2 * q + r) ** 2 for p, q, r in zip(a, b, c)))
    return math.sqrt(statistics.fmean(squares)) if squares else None


class Tally:
    def __init__(self):
        self.counted = self.right = self.wrong = self.felt = 0
        self.without_object = self.false = 0
        self.jitters = []
        self.true_jitters = []

    def add(self, motion, seconds, height, truth):
        unit = height / REFERENCE_LINES
        felt = [math.hypot(*v) > FELT_PX_S * s * unit and s > 0 for v, s in zip(motion, seconds)]
        if truth is None:
            self.without_object += len(motion) - 2
            self.false += sum(felt[2:])
            return
        frames = [n for n in truth if 2 <= n < len(motion)]
        for n in frames:
            true_px = math.hypot(*truth[n])
            if true_px <= LEAST_TRUE_PX * unit:
                continue
            self.counted += 1
            if not felt[n]:
                continue
            self.felt += 1
            found_px = math.hypot(*motion[n])
            cosine = sum(p * q for p, q in zip(motion[n], truth[n])) / (found_px * true_px)
            near = true_px / 2 < found_px < 2 * true_px
            self.right += near and cosine > math.cos(math.radians(30))
            self.wrong += cosine < math.cos(math.radians(60))
        known = set(frames)
        for each, to in ((motion, self.jitters), (truth, self.true_jitters)):
            value = jitter(each, known)
            if value is not None:
                to.append(value / unit)

    def row(self, name):
        def share(part, whole):
            return f"{100 * part / whole:.1f}" if whole else "-"

        def middle(values):
            return f"{statistics.median(values):.2f}" if values else "-"

        return (f"| {name} | {share(self.right, self.counted)} | {share(self.wrong, self.counted)} "
                f"| {share(self.felt, self.counted)} "
                f"| {share(self.false, self.without_object)} "
                f"| {middle(self.jitters)} ({middle(self.true_jitters)}) |")


class Calm:
    """How steady the force of some films is."""

    def __init__(self):
        self.frames = self.felt = self.changes = self.turns = self.runs = self.steps = 0
        self.square_N2 = self.seconds = self.felt_s = 0.0

    def add(self, rows):
        before_N, before_s, last = None, rows[0]["running_time_ns"] * 1e-9, None
        for row in rows:
            force_N, seconds = row["wrench"]["force_N"], row["running_time_ns"] * 1e-9 - before_s
            before_s += seconds
            self.frames += 1
            self.seconds += seconds
            if before_N:
                self.steps += 1
                self.square_N2 += math.dist(force_N, before_N) ** 2
                both = min(math.hypot(*force_N), math.hypot(*before_N)) >= FELT_N
                self.turns += both and sum(p * q for p, q in zip(force_N, before_N)) < 0
            before_N = force_N
            if math.hypot(*force_N) < FELT_N:
                continue
            self.felt += 1
            self.felt_s += seconds
            # 0: none, the force fades
            if row["object"] not in (0, last):
                self.runs, self.changes, last = self.runs + 1, self.changes + (last is not None), row["object"]

    def row(self, name):
        minutes = max(self.seconds / 60, 1e-9)
        return (f"| {name} | {self.seconds:.0f} | {self.changes / minutes:.0f} | {self.turns / minutes:.0f} "
                f"| {math.sqrt(self.square_N2 / max(self.steps, 1)):.2f} | {100 * self.felt / max(self.frames, 1):.0f} "
                f"| {self.felt_s / max(self.runs, 1):.1f} |")


def print_calm(build, films):
    print("| film | s | changes/min | turns/min | step, N | felt % | run, s |\n" + "|---" * 7 + "|")
    together = Calm()
    for film in films:
        calm = Calm()
        rows = analyse(build, film, []) or sys.exit(f"real_films.py: {film} has no frames")
        for each in (calm, together):
            each.add(rows)
        print(calm.row(film.name), flush=True)
    print(together.row("all"))


def measure(program, method, film):
    """As play() does, and the milliseconds of each frame; without the times between frames, which
    count for nothing but whether a motion is felt."""
    with tempfile.TemporaryDirectory() as folder:
        if method == "vectors":
            coded = Path(folder) / "coded.mp4"
            subprocess.run(
                ["ffmpeg", "-loglevel", "error", "-i", film, "-an", "-c:v", "libx264", "-bf", "0", "-refs", "1",
                 "-crf", "20", coded], check=True)
            film = coded
        lines = subprocess.run([program, method, film], check=True, stdout=subprocess.PIPE,
                               text=True).stdout.splitlines()
    rows = [[float(v) for v in line.split(",")] for line in lines]
    motion = [(row[1], row[2]) for row in rows]
    return motion, [1 / FRAMES_A_SECOND] * len(rows), rows[0][4], [row[3] for row in rows]


def compare_methods(build, films):
    program = build / "tests" / "bench" / "bench_real_film"
    table = Table("Methods", "method", "ms a frame", "right %", "wrong %", "any force %", "false %", "jitter (true)")
    for method, name in METHODS.items():
        tally, times_ms = Tally(), []
        for film in films:
            *found, ms = measure(program, method, film)
            times_ms += ms[2:]
            truth = film.with_suffix(".csv")
            tally.add(*found, read_truth(truth) if truth.exists() else None)
        time_ms = statistics.median(times_ms)
        table.add(tally.row(f"{name} | {time_ms:.2f}"))


def compare_settings(build, older, films):
    table = Table("Settings", "settings", "right %", "wrong %", "any force %", "false %", "jitter (true), px")
    runs = [(build, properties, " ".join(properties) or "default") for properties in SETTINGS]
    if older:
        runs.append((older, [], "an older version"))
    for which, properties, name in runs:
        tally = Tally()
        for film in films:
            truth = film.with_suffix(".csv")
            tally.add(*play(which, film, properties), read_truth(truth) if truth.exists() else None)
        table.add(tally.row(NAMES.get(name) or (f"`{name}`" if properties else name)))


def count_models(build, films):
    """How often each model of the camera's motion is chosen."""
    rungs = ["still", "translation", "similarity", "affine", "homography"]
    table = Table("Models of the camera's motion", "films", *(f"{rung} %" for rung in rungs), "unknown or plain %")
    for name, chosen in (("with an object", [f for f in films if f.with_suffix(".csv").exists()]),
                         ("camera only", [f for f in films if not f.with_suffix(".csv").exists()])):
        found = Counter(row["background"]["model"] if row["background"]["coverage"] > 0 else "unknown"
                        for film in chosen for row in analyse(build, film, []) if row["background"])
        if found:
            shares = [f"{100 * found[rung] / found.total():.0f}" for rung in [*rungs, "unknown"]]
            table.add(f"| {name} | " + " | ".join(shares) + " |")


def check_plugin(build):
    if not list((build / "plugin").glob("libgstspidar.*")):
        sys.exit(f"real_films.py: no plugin in {build}/plugin: build it with meson compile")


def check(builds):
    """What is missing is said before the minutes that the first tables take."""
    for build in builds:
        check_plugin(build)
    if not (builds[0] / "tests" / "bench" / "bench_real_film").exists() or not shutil.which("ffmpeg"):
        sys.exit("real_films.py: the table of methods needs libavformat-dev (after which: meson configure "
                 f"--clearcache {builds[0]}; meson setup --reconfigure {builds[0]}) and ffmpeg")


def main():
    if len(sys.argv) > 3 and sys.argv[2] == "--calm":
        build, missing = Path(sys.argv[1]).resolve(), [f for f in sys.argv[3:] if not Path(f).is_file()]
        if missing:
            sys.exit(f"real_films.py: no film {', '.join(missing)}")
        check_plugin(build)
        return print_calm(build, [Path(f) for f in sys.argv[3:]])
    if len(sys.argv) not in (3, 4) or sys.argv[2].startswith("-"):
        sys.exit("usage: real_films.py BUILD FOLDER [OLDER_BUILD], or real_films.py BUILD --calm FILM...")
    build, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    older = Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
    if not folder.is_dir():
        sys.exit(f"real_films.py: {folder} is not a folder")
    films = sorted(f for f in folder.iterdir() if f.suffix not in (".csv", ".md", ".txt", ".py"))
    films = [f for f in films if f.is_file()]
    if not films:
        sys.exit(f"real_films.py: no films in {folder}")
    if not any(f.with_suffix(".csv").exists() for f in films):
        sys.exit(f"real_films.py: no film in {folder} has a NAME.csv with the true motion of its object")
    check([build] + ([older] if older else []))
    count_models(build, films)
    compare_settings(build, older, films)
    compare_corners(build, films)
    compare_methods(build, films)


if __name__ == "__main__":
    main()
