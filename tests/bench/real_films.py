#!/usr/bin/env python3
"""Is the right motion felt in real films? real_films.py BUILD FOLDER: runs spidarmotion of a meson
build folder over the films of FOLDER and prints a table with a row for each of its settings.

FOLDER holds films that GStreamer can decode. Beside a film, NAME.csv gives the true motion of its
object against the background: lines `frame,x,y`, the first frame being 0, in pixels of the film
since the frame before, x right, y down; frames that are missing are not counted. A film without
such a file has no object, only a camera that moves.

right: within 30 degrees and a factor of 2 of the truth. wrong: felt and more than 60 degrees off.
Counted are frames with more than 1 px of true motion, of a frame 480 lines high. false: frames of
films without an object in which some motion is felt. jitter: root mean square of the second
difference of the motion, px of a frame 480 lines high, median over the films, beside that of the
truth. felt: more than 2.1 px/s of a frame 480 lines high."""

import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

REFERENCE_LINES = 480
FELT_PX_S = 2.1
LEAST_TRUE_PX = 1.0
SETTINGS = [
    [],
    ["quality=fast"],
    ["quality=fine"],
    ["tracker=opencv"],
    ["motion=mean"],
    ["tracker=opencv", "motion=mean", "filter-min-cutoff=0"],
]


def read_truth(file):
    """Motion by frame, px."""
    with open(file, newline="") as lines:
        return {int(n): (float(x), float(y)) for n, x, y in csv.reader(lines)}


def play(build, film, properties):
    """Motion of each frame in px since the frame before, the seconds since then, the height."""
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder) / "trace.jsonl"
        environment = dict(
            os.environ,
            GST_PLUGIN_PATH=str(build / "plugin"),
            GST_REGISTRY=str(Path(folder) / "registry"),
        )
        environment.setdefault("SPIDAR_PROFILE_PATH", "spidar/profiles/shipped")
        subprocess.run(
            ["gst-launch-1.0", "-q", "filesrc", f"location={film}", "!", "decodebin", "!",
             "spidarmotion", "device=none", "post-messages=false", f"trace={trace}", *properties,
             "!", "fakesink", "sync=false"],
            env=environment, check=True, stdout=subprocess.DEVNULL)
        rows = [json.loads(line) for line in trace.read_text().splitlines()]
    motion = []
    for row in rows:
        seconds = row["interval_ns"] * 1e-9
        motion.append(tuple(v * seconds for v in row["motion"]["velocity_px_s"]))
    return motion, [row["interval_ns"] * 1e-9 for row in rows], rows[0]["height_px"]


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


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: real_films.py BUILD FOLDER")
    build, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    films = sorted(f for f in folder.iterdir() if f.suffix not in (".csv", ".md", ".txt", ".py"))
    films = [f for f in films if f.is_file()]
    if not films:
        sys.exit(f"real_films.py: no films in {folder}")
    print("| settings | right % | wrong % | felt % | false % | jitter (true) |")
    print("|---|---|---|---|---|---|")
    for properties in SETTINGS:
        tally = Tally()
        for film in films:
            truth = film.with_suffix(".csv")
            tally.add(*play(build, film, properties),
                      read_truth(truth) if truth.exists() else None)
        print(tally.row(" ".join(properties) or "default"), flush=True)


main()
