#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares the blocks of the felt object with the masks of DAVIS 2016: region similarity J, for each sequence.

  tests/bench/davis.py [--only NAME,...] [--published FOLDER] DAVIS      with the spidarmotion of build/, or $BUILD

DAVIS is the folder with JPEGImages/480p/NAME and Annotations/480p/NAME (Perazzi et al., CVPR 2016; https://davischallenge.org,
CC BY-NC 4.0). --published is json_data/raw_eval/2016 of https://github.com/davisvideochallenge/davisvideochallenge.github.io
(no licence is stated), which has J of each frame for FST, NLC, CVOS, TRC, MSG, KEY and SAL, methods without a given mask.
Nothing of them is part of this repository, and none is downloaded.
Constants were chosen with blackswan, bmx-trees, camel, dance-twirl, dog, drift-straight, goat, horsejump-high,
motocross-jump and paragliding-launch of its validation set: only the other sequences give a blind figure.

J: intersection over union with the mask, mean over all frames but the first and the last, as in the published results;
a frame in which nothing is felt has 0. The object is the union of its blocks, 16 px of the reduced picture (32 px of
DAVIS's 854 × 480), so its edge cannot follow a mask. ceiling: J of the blocks that are at least half covered by the
mask: what no choice of blocks exceeds by much. listed: J of the listed object that fits best, felt or not. nothing:
frames in which no object is listed. "another" says that a better one was listed, "outline" that the object was found
and its edge is what is lost, "not found" that most frames list nothing that shares a fifth with the mask. Needs python3-gi,
numpy, python3-opencv and ffmpeg."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ImportError:
    sys.exit("davis.py: needs numpy (python3-numpy), for the interpreter that runs it")
try:
    import cv2
except ImportError:
    cv2 = None  # what needs no pictures goes without

from real_films import print_head

PUBLISHED = ("fst", "nlc", "cvos", "trc", "msg", "key", "sal")
FOUND = 0.2  # J of an object that at least lies on the mask
NOTHING = -1  # id of no object


def region_similarity(found, mask):
    """Intersection over union; 1 where both are empty, as in DAVIS's evaluation."""
    union = np.count_nonzero(found | mask)
    return np.count_nonzero(found & mask) / union if union else 1.0


def block_step(points):
    """Distance of neighbouring blocks, px; 0 where there are too few."""
    steps = [np.diff(np.unique(np.round(points[:, axis], 3))) for axis in (3, 4)]
    return min((step.min() for step in steps if len(step)), default=0)


def paint(points, step, shape):
    """The union of the blocks: squares around where they are in this frame."""
    mask = np.zeros(shape, bool)
    for x, y in points[:, 3:5]:
        low = np.maximum(np.round(np.array([y, x]) + 0.5 - step / 2).astype(int), 0)
        high = np.round(np.array([y, x]) + 0.5 + step / 2).astype(int)
        mask[low[0]:high[0], low[1]:high[1]] = True
    return mask


def ceiling(mask, points, step):
    """The union of the blocks that the mask covers by half, of all places where the frame has blocks."""
    x0, y0 = points[0, 3:5] - step / 2
    found = np.zeros_like(mask)
    for x in np.arange((x0 + 0.5) % step - step, mask.shape[1], step):
        for y in np.arange((y0 + 0.5) % step - step, mask.shape[0], step):
            rows = slice(max(round(y), 0), max(round(y + step), 0))
            columns = slice(max(round(x), 0), max(round(x + step), 0))
            part = mask[rows, columns]
            if part.size and part.mean() >= 0.5:
                found[rows, columns] = True
    return found


def play(build, film):
    """For each frame that is analysed: its number, its points (from x, y, to x, y, object), and the felt object."""
    os.environ["GST_PLUGIN_PATH"] = str(build / "plugin")
    os.environ.setdefault("GST_REGISTRY", str(build / "davis.registry"))
    import gi

    gi.require_version("Gst", "1.0")
    gi.require_version("GstVideo", "1.0")
    from gi.repository import Gst

    Gst.init(None)
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder, "trace.jsonl")
        pipeline = Gst.parse_launch(
            f'filesrc location="{film}" ! decodebin ! spidarmotion device=none attach-meta=true post-messages=false '
            f'trace="{trace}" ! appsink name=sink sync=false')
        sink = pipeline.get_by_name("sink")
        pipeline.set_state(Gst.State.PLAYING)
        frames = []
        while sample := sink.emit("pull-sample"):
            meta = sample.get_buffer().get_custom_meta("GstSpidarMotionMeta")
            points = meta.get_structure().get_value("points").unpack() if meta else []
            frames.append(np.array(points, float).reshape(-1, 6))
        pipeline.set_state(Gst.State.NULL)
        felt = [json.loads(line).get("object", 0) or NOTHING for line in trace.read_text().splitlines()]
    return list(zip(frames, felt))


def judge(frames, masks):
    """J of the felt object and of the best one listed, and the ceiling, in each frame but the first and the last."""
    rows = []
    step = next((step for points, _ in frames if (step := block_step(points)) > 0), 0)
    for (points, felt), mask in list(zip(frames, masks))[1:-1]:
        by_object = {each: region_similarity(paint(points[points[:, 5] == each], step, mask.shape), mask)
                     for each in np.unique(points[:, 5]) if each > 0}
        empty = 0.0 if mask.any() else 1.0
        most = region_similarity(ceiling(mask, points, step), mask) if len(points) else np.nan
        rows.append((by_object.get(felt, empty), max(by_object.values(), default=empty), most, not by_object))
    return np.array(rows, float)


def reason(rows):
    """Where most is lost."""
    felt, listed, most = np.nanmean(rows[:, :3], axis=0)
    if (rows[:, 1] < FOUND).mean() > 0.5:
        return "not found"
    return "another" if listed - felt > most - listed else "outline"


def read_published(folder):
    """Mean J by method and sequence."""
    means = {}
    for method in PUBLISHED:
        content = json.loads(Path(folder, f"{method}_davis.json").read_text())
        means[method] = {name: np.mean([float(j) for j in values["J"]]) for name, values in content.items()
                         if name != "id"}
    return means


def read_mask(file):
    mask = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
    return (mask.max(axis=2) if mask.ndim == 3 else mask) > 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", help="names of sequences, with commas between them", default="")
    parser.add_argument("--published", help="folder with the published results")
    parser.add_argument("folder", nargs="?")
    options = parser.parse_args()
    if not options.folder:
        print("skipped: no folder; usage: tests/bench/davis.py [--only NAME,...] [--published FOLDER] DAVIS")
        return
    annotations, images = (Path(options.folder, name, "480p") for name in ("Annotations", "JPEGImages"))
    names = options.only.split(",") if options.only else sorted(f.name for f in annotations.glob("*") if f.is_dir())
    if missing := [name for name in names if not (annotations / name).is_dir() or not (images / name).is_dir()]:
        sys.exit(f"davis.py: {options.folder} has no {', '.join(missing)} in both Annotations/480p and JPEGImages/480p")
    if not names:
        sys.exit(f"davis.py: there are no sequences in {annotations}")
    if not cv2:
        sys.exit("davis.py: needs OpenCV for Python (python3-opencv), for the interpreter that runs it")
    build = Path(os.environ.get("BUILD", "build")).resolve()
    published = read_published(options.published) if options.published else {}
    print_head("sequence", "felt", "listed", "ceiling", "nothing %", "lost by", *map(str.upper, published))
    table = []
    with tempfile.TemporaryDirectory() as scratch:
        for name in names:
            pictures = sorted((images / name).glob("*.jpg"))
            masks = [read_mask(file) for file in sorted((annotations / name).glob("*.png"))]
            film = Path(scratch, f"{name}.mkv")
            subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", "24", "-i", "-", "-c",
                            "copy", film], check=True, input=b"".join(file.read_bytes() for file in pictures))
            rows = judge(play(build, film), masks)
            others = [method.get(name, np.nan) for method in published.values()]
            table.append([*np.nanmean(rows, axis=0), *others])
            print(line(name, table[-1], reason(rows)), flush=True)
    random = np.random.default_rng(1)
    table = np.array(table)
    print(line("mean", table.mean(axis=0), ""))
    means = [table[random.integers(len(table), size=len(table)), 0].mean() for _ in range(10000)]
    print("\nfelt, 95 % interval over sequences (bootstrap): {:.3f} to {:.3f}".format(*np.percentile(means, (2.5, 97.5))))


def line(name, values, why):
    felt, listed, most, nothing, *others = values
    cells = [f"{felt:.3f}", f"{listed:.3f}", f"{most:.3f}", f"{100 * nothing:.0f}", why, *(f"{j:.3f}" for j in others)]
    return f"| {name} | " + " | ".join(cells) + " |"


if __name__ == "__main__":
    main()
