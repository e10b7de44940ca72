#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures whether the right motion is felt in real films:

  tests/bench/real_films.sh FOLDER...                        the spidarmotion of build/
  BUILD=FOLDER tests/bench/real_films.sh ...                 of another build folder
  tests/bench/real_films.py FOLDER... --other NAME=FOLDER    also of another method, from what it has measured; needs
                                                             only the plugin, no benchmarks

In the folder of another method, NAME.csv for each film has what it found to move, in lines as those of the truth;
frames that are missing move nothing.

A FOLDER holds films that GStreamer can decode. Beside a film, NAME.csv gives the true motion of its
object against the background: lines `frame,x,y`, the first frame being 0, in pixels of the film
since the frame before, x right, y down; frames that are missing are not counted. A film without
such a file has no object, only a camera that moves. truth.py makes such a folder from a data set.

right: within 30 degrees and a factor of 2 of the truth. wrong: felt and more than 60 degrees off. Counted are
frames with more than 1 px of true motion, of a frame 480 lines high, not the first two. false: frames of films
without an object in which some motion is felt. felt: more than 2.1 px/s of a frame 480 lines high.

mean of films: of right %, each film counting once; below half: how many films are. truth: of the frames of films with an
object, how many have a truth. Truths rest on brightness that stays as it is, as the measured motion does.

In brackets, the 95 % interval of a share over films (shares.py). The second table has the share of right frames
for other angles and factors than these; the third that of right and false frames if only a motion that is so many times
faster counts as felt, and right less false: the one number that tells methods apart, since both errors count alike in it,
and whoever always or never finds a motion has 0 at the most. The fourth compares each method with the first by films.

ms: processor time of a frame without decoding: median, 99 %, longest."""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from shares import CURVE_COLUMNS, curve, mean_of_films, paired, right_less_false, share

REFERENCE_LINES = 480
FELT_PX_S = 2.1
LEAST_TRUE_PX = 1.0
FELT_N = 0.04  # the least force that a hand feels
FASTER = (1, 2, 4, 8, 16, 32)  # than FELT_PX_S
FRAMES_A_SECOND = 24  # what FELT_PX_S is a speed of where times are not known
UNSEEN = 2  # frames at the beginning of a film
# Of `spidar-bench real_film`, and their names in the table.
METHODS = {"dis:medium:0.5": "DIS at half size, largest region", "vectors": "H.264 vectors, largest region"}
PAPER = ["motion=mean", "filter-min-cutoff=0"]
PAIRED = (("right", "counted"), ("wrong", "counted"), ("false", "without_object"))
COLUMNS = ["", "right %", "mean of films, below half", "truth %", "wrong %", "false %", "ms"]


def print_head(*columns):
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|", flush=True)


def read_motion(file):
    """By frame, px since the frame before."""
    motion = {}
    with open(file, newline="") as lines:
        for number, line in enumerate(csv.reader(lines), 1):
            try:
                n, x, y = line
                motion[int(n)] = float(x), float(y)
            except ValueError:
                sys.exit(f"real_films.py: {file}, line {number}: is to be frame,x,y in px: {','.join(line)}")
    return motion


def read_truth(film):
    """Nothing for a film without an object."""
    file = film.with_suffix(".csv")
    return read_motion(file) if file.exists() else None


def other_file(folder, film):
    file = folder / film.with_suffix(".csv").name
    if not file.exists():
        sys.exit(f"real_films.py: {file} is missing: what the method found in {film.name}")
    return file


def read_other(folder, film, frames):
    """The frames of a film as another method found them; their times and sizes are those of `frames`."""
    file = other_file(folder, film)
    motion = read_motion(file)
    if motion and not 0 <= min(motion) <= max(motion) < len(frames):
        sys.exit(f"real_films.py: {file}: frames are 0 to {len(frames) - 1} in {film.name}")
    return [Frame(motion.get(n, (0, 0)), frame.seconds, frame.height) for n, frame in enumerate(frames)]


class Frame:
    """What was found in a frame: its motion, px since the frame before; the force, N."""

    def __init__(self, motion, seconds, height, force_N=None):
        self.motion, self.seconds, self.height, self.force_N = motion, seconds, height, force_N
        self.speed_px_s = math.hypot(*motion) / (seconds * height / REFERENCE_LINES) if seconds > 0 else 0
        self.is_felt = self.speed_px_s > FELT_PX_S


def trace_rows(build, film, properties=()):
    """A row for each frame of a film, as spidarmotion traces it (docs/elements.md)."""
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder) / "trace.jsonl"
        environment = dict(os.environ, GST_PLUGIN_PATH=str(build / "plugin"),
                           GST_REGISTRY=str(build / "real_films.registry"))
        environment.setdefault("SPIDAR_PROFILE_PATH", "spidar/profiles/shipped")
        subprocess.run(
            ["gst-launch-1.0", "-q", "filesrc", f"location={film}", "!", "decodebin", "!", "spidarmotion",
             "device=none", "post-messages=false", f"trace={trace}", *properties, "!", "fakesink", "sync=false"],
            env=environment, check=True, stdout=subprocess.DEVNULL)
        return [json.loads(line) for line in trace.read_text().splitlines()]


def play(build, film, properties=()):
    """The frames of a film."""
    frames = []
    for row in trace_rows(build, film, properties):
        seconds = row["interval_ns"] * 1e-9
        moved = tuple(v * seconds for v in row["motion"]["velocity_px_s"])
        frames.append(Frame(moved, seconds, row["height_px"], row["wrench"]["force_N"]))
    return frames


def measure(program, method, film):
    """The frames of a film as one of METHODS finds them, by threshold, and the milliseconds that each takes."""
    with tempfile.TemporaryDirectory() as folder:
        if method == "vectors":
            coded = Path(folder) / "coded.mp4"
            subprocess.run(["ffmpeg", "-loglevel", "error", "-i", film, "-an", "-c:v", "libx264", "-bf", "0", "-refs",
                            "1", "-crf", "20", coded], check=True)
            film = coded
        lines = subprocess.run([program, "real_film", method, film], check=True, stdout=subprocess.PIPE,
                               text=True).stdout.splitlines()
    rows = [[float(v) for v in line.split(",")] for line in lines]
    frames = [[Frame((row[at], row[at + 1]), 1 / FRAMES_A_SECOND, row[2]) for row in rows] for at in range(3, len(rows[0]), 2)]
    return frames, [row[1] for row in rows[UNSEEN:]]


def verdict(motion, true):
    """right, wrong or neither."""
    found_px, true_px = math.hypot(*motion), math.hypot(*true)
    if found_px == 0:
        return ""
    cosine = sum(p * q for p, q in zip(motion, true)) / (found_px * true_px)
    if cosine > math.cos(math.radians(30)) and true_px / 2 < found_px < 2 * true_px:
        return "right"
    return "wrong" if cosine < math.cos(math.radians(60)) else ""


def apart(motion, true):
    """Angle in degrees and ratio of lengths."""
    found_px, true_px = math.hypot(*motion), math.hypot(*true)
    cosine = sum(p * q for p, q in zip(motion, true)) / (found_px * true_px)
    return math.degrees(math.acos(max(-1, min(1, cosine)))), found_px / true_px


class Tally:
    """What was right and wrong in some films."""

    def __init__(self):
        self.counted = self.right = self.wrong = 0
        self.without_object = self.false = self.with_object = self.known = 0
        self.times_ms = []
        self.films = []  # sums() of each
        self.apart = []  # of each with an object: angle and ratio of speeds in the counted frames, None where none is felt
        self.right_px_s, self.false_px_s = [], []  # of each film: speeds that were found where they are right, and false

    def sums(self):
        return Counter(right=self.right, wrong=self.wrong, counted=self.counted, false=self.false,
                       without_object=self.without_object, with_object=self.with_object, known=self.known)

    def add(self, frames, truth, times_ms=()):
        before = self.sums()
        self.add_film(frames, truth, times_ms)
        self.films.append({name: value - before[name] for name, value in self.sums().items()})

    def add_film(self, frames, truth, times_ms):
        self.times_ms += times_ms
        self.right_px_s.append([])
        self.false_px_s.append([frame.speed_px_s for frame in frames[UNSEEN:]] if truth is None else [])
        if truth is None:
            self.without_object += len(frames) - UNSEEN
            self.false += sum(frame.is_felt for frame in frames[UNSEEN:])
            return
        unit = frames[0].height / REFERENCE_LINES
        known = [n for n in truth if UNSEEN <= n < len(frames)]
        self.with_object += len(frames) - UNSEEN
        self.known += len(known)
        self.apart.append([])
        for n in known:
            if math.hypot(*truth[n]) <= LEAST_TRUE_PX * unit:
                continue
            found = verdict(frames[n].motion, truth[n]) if frames[n].is_felt else ""
            self.apart[-1].append(apart(frames[n].motion, truth[n]) if frames[n].is_felt else None)
            self.counted += 1
            self.right += found == "right"
            self.right_px_s[-1] += [frames[n].speed_px_s] * (found == "right")
            self.wrong += found == "wrong"

    def trade_row(self, name):
        """What becomes of right and false if only faster motions count as felt."""
        of = lambda speeds, whole, faster: [(sum(each > faster * FELT_PX_S for each in found), film[whole])
                                            for found, film in zip(speeds, self.films)]
        pairs = [(of(self.right_px_s, "counted", faster), of(self.false_px_s, "without_object", faster)) for faster in FASTER]
        return " | ".join([f"| {name}", *(f"{share(right)}, {share(false)}" for right, false in pairs),
                           right_less_false(*pairs[0]) + " |"])

    def counts(self, part, whole):
        return [(film.get(part, 0), film[whole]) for film in self.films]

    def film_cells(self):
        """Of each film right % and wrong %, or false %."""
        return [f"{100 * film['right'] / film['counted']:.0f}, {100 * film['wrong'] / film['counted']:.0f}" if film["counted"] else
                f"{100 * film['false'] / film['without_object']:.0f}" if film["without_object"] else "-" for film in self.films]

    def row(self, name):
        of = lambda part, whole="counted": share([(film.get(part, 0), film[whole]) for film in self.films])
        times = sorted(self.times_ms)
        ms = f"{times[len(times) // 2]:.2f}, {times[len(times) * 99 // 100]:.2f}, {times[-1]:.2f}" if times else "-"
        by_film = mean_of_films([(film.get("right", 0), film["counted"]) for film in self.films])
        return (f"| {name} | {of('right')} | {by_film} | {of('known', 'with_object')} | {of('wrong')} "
                f"| {of('false', 'without_object')} | {ms} |")


def films_of(folders):
    films = []
    for folder in folders:
        if not folder.is_dir():
            sys.exit(f"real_films.py: {folder} is not a folder")
        found = sorted(f for f in folder.iterdir() if f.is_file() and f.suffix not in (".csv", ".md", ".txt", ".py"))
        films += found or sys.exit(f"real_films.py: no films in {folder}")
    return films


def main():
    build = Path(os.environ.get("BUILD", "build")).resolve()
    parser = argparse.ArgumentParser(usage="tests/bench/real_films.sh FOLDER... [--other NAME=FOLDER]...")
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--other", action="append", default=[])
    options = parser.parse_args()
    others = [(name, Path(folder)) for name, _, folder in (other.partition("=") for other in options.other)]
    for name, folder in others:
        if not folder.is_dir():
            parser.error(f"--other {name}={folder}: NAME=FOLDER, a folder with a file .csv for each film")
    films = films_of(options.folders)
    for _, folder in others:  # before minutes of work
        for film in films:
            read_motion(other_file(folder, film))
    if not list((build / "plugin").glob("libgstspidar.*")):
        sys.exit(f"real_films.py: no plugin in {build}/plugin: build it with meson compile")
    program = build / "tests" / "bench" / "spidar-bench"
    measures = program.exists() and "real_film" in subprocess.run([program], check=False, stdout=subprocess.PIPE,
                                                                  text=True).stdout
    if not measures:
        print("No ms, and no methods of spidar-bench: it is not built, or without libavformat-dev.\n")

    tallies = {}
    played = {}  # the frames of each film
    print_head(*COLUMNS)
    for name, properties in (("this version", ()), ("closest to the paper", PAPER)):
        tally = Tally()
        for film in films:
            times_ms = measure(program, "paper" if properties else "object:1", film)[1] if measures else ()
            played[film] = play(build, film, properties)
            tally.add(played[film], read_truth(film), times_ms)
        print(tally.row(name), flush=True)
        tallies[name] = tally
    for method, name in METHODS.items() if measures else ():
        tally = Tally()
        for film in films:
            (frames, *_), times_ms = measure(program, method, film)
            tally.add(frames, read_truth(film), times_ms)
        print(tally.row(name), flush=True)
        tallies[name] = tally

    for name, folder in others:
        tally = Tally()
        for film in films:
            tally.add(read_other(folder, film, played[film]), read_truth(film))
        print(tally.row(name), flush=True)
        tallies[name] = tally

    print("\nRight %, if another angle (at a factor of 2) or another factor (at 30°) counts as right:\n")
    print_head(*CURVE_COLUMNS)
    print("\n".join(curve(name, tally.apart) for name, tally in tallies.items()))
    print(f"\nRight %, false % if a motion counts as felt from so many times {FELT_PX_S} px/s on, and right less false:\n")
    print_head("", *(f"×{faster}" for faster in FASTER), "right − false")
    print("\n".join(tally.trade_row(name) for name, tally in tallies.items()))
    first = tallies["this version"]
    print("\nThis version less each other one, mean of films in %, and p of the paired test:\n")
    print_head("", "right", "wrong", "false")
    for name, tally in list(tallies.items())[1:]:
        print(" | ".join([f"| {name}", *(paired(first.counts(*of), tally.counts(*of)) for of in PAIRED)]) + " |")
    print("\nEach film: right %, wrong % of those with an object, false % of the others:\n")
    print_head("", *tallies)
    for film, *cells in zip(films, *(tally.film_cells() for tally in tallies.values())):
        print(" | ".join([f"| {film.stem}", *cells]) + " |")


if __name__ == "__main__":
    main()
