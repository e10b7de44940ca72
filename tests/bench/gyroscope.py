#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares motion=camera with a gyroscope that was beside the camera, and DIS + homography with it, too:

  tests/bench/gyroscope.py FOLDER...           with the spidarmotion of build/, or $BUILD

A FOLDER has, at any depth, films of either kind; nothing of them is part of this repository, and none is downloaded:
  films of a GoPro with a metadata track (gpmd), such as samples/karma.mp4 of
    https://github.com/gopro/gpmf-parser, commit 9a715063 (Apache-2.0 or MIT);
  folders with framestamp.txt (seconds, one line for each frame of the whole film), gyro.txt (x, y, z in rad/s and
    seconds) and reshape/RE_frame-N.jpg, N counting the lines of framestamp.txt from 1, such as 20200109_145447 of
    https://github.com/lhaippp/gyro-video-stabilization, commit 480a1ead (MIT).

A camera that turns at ω rad/s moves the middle of its picture by f ω px/s, f being the focal length. For each axis of
the camera, the axis of the gyroscope and its sign, one lag for all, and one f are found by least squares, from both
methods together, so that neither is preferred. These few numbers are found in the frames
that are reported. What the camera does besides turning (it also moves) is in the error.

r: correlation with the gyroscope. slope: of the measured speed over the gyroscope's (1: neither too large nor too
small), by least squares. error: root mean square of the difference, degrees/s, beside the standard deviation of the
gyroscope's rate. Where that is below 1 degree/s, the camera hardly turned, and r says nothing. Intervals of 95 % are bootstrapped over blocks of a second, because neighbouring frames depend on
each other. No table without numpy, python3-opencv and ffmpeg."""

import json
import os
import struct
import subprocess
import sys
import tempfile
from itertools import permutations
from pathlib import Path

try:
    import numpy as np
except ImportError:
    sys.exit("gyroscope.py: needs numpy (python3-numpy), for the interpreter that runs it")
try:
    import cv2
except ImportError:
    cv2 = None  # what needs no pictures goes without

from real_films import trace_rows

AXES = ("yaw", "pitch", "roll")
METHODS = ("motion=camera", "DIS + homography")
LAGS_S = 0.1  # of the gyroscope's times against those of the frames, either way
LAG_STEP_S = 0.001
BLOCK_S = 1.0
RESAMPLES = 2000
GRID_PX = 16  # of the points from which the homography is fitted
INLIER_PX = 1.0  # in a frame of 480 lines


def items(data):
    """Key, type, size of a value, and bytes of each item of GPMF, by its description in gpmf-parser's README."""
    at = 0
    while at + 8 <= len(data):
        key, kind, size, count = struct.unpack(">4scBH", data[at:at + 8])
        yield key, kind, size, data[at + 8:at + 8 + size * count]
        at += 8 + (size * count + 3) // 4 * 4


def gyro_samples(data):
    """Rows in rad/s of the first stream with a gyroscope in a payload. Their order of axes is the file's."""
    for key, kind, _, device in items(data):
        if key != b"DEVC" or kind != b"\0":
            continue
        for key, _, _, stream in items(device):
            if key != b"STRM":
                continue
            inside = {key: (kind, size, value) for key, kind, size, value in items(stream)}
            if b"GYRO" not in inside or b"SCAL" not in inside:
                continue
            formats = {b"s": "h", b"l": "i", b"f": "f"}
            kind, _, value = inside[b"SCAL"]
            scale = struct.unpack(">" + formats[kind], value[:struct.calcsize(formats[kind])])[0]
            kind, size, value = inside[b"GYRO"]
            numbers = struct.unpack(f">{len(value) // struct.calcsize(formats[kind])}{formats[kind]}", value)
            return [[number / scale for number in numbers[n:n + 3]] for n in range(0, len(numbers), 3)]
    return []


def probe(film, *what):
    return json.loads(subprocess.run(["ffprobe", "-v", "error", *what, "-of", "json", film], check=True,
                                     stdout=subprocess.PIPE).stdout)


def read_gopro(film):
    """Times in s and rates in rad/s of the gyroscope of a film, or nothing."""
    streams = probe(film, "-show_entries", "stream=index,codec_tag_string")["streams"]
    index = [stream["index"] for stream in streams if stream.get("codec_tag_string") == "gpmd"]
    if not index:
        return None
    packets = probe(film, "-select_streams", str(index[0]), "-show_entries", "packet=pts_time,duration_time,size,pos")
    times_s, rates, content = [], [], Path(film).read_bytes()
    for packet in packets["packets"]:
        begin = int(packet["pos"])
        rows = gyro_samples(content[begin:begin + int(packet["size"])])
        for n in range(len(rows)):
            times_s.append(float(packet["pts_time"]) + float(packet["duration_time"]) * n / len(rows))
        rates += rows
    return (np.array(times_s), np.array(rates)) if rates else None


def read_pictures(folder, out):
    """A film of the pictures, the times of its frames, and the gyroscope."""
    pictures = sorted((folder / "reshape").glob("RE_frame-*.jpg"), key=lambda file: int(file.stem.split("-")[1]))
    stamps = np.loadtxt(folder / "framestamp.txt")
    gyro = np.loadtxt(folder / "gyro.txt", delimiter=",")
    times_s = stamps[[int(file.stem.split("-")[1]) - 1 for file in pictures]]
    rate = 1 / np.median(np.diff(times_s))
    subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", f"{rate:.6f}", "-i", "-", "-c",
                    "copy", out], check=True, input=b"".join(file.read_bytes() for file in pictures))
    return out, times_s - times_s[0], gyro[:, 3] - times_s[0], gyro[:, :3]


def by_element(build, film):
    """Times and rates (px/s of yaw and pitch, rad/s of roll) of the frames, and the width and height of the picture.

    With motion=camera the viewer moves with the camera: the velocity is the opposite of the picture's."""
    rows = trace_rows(build, film, ["motion=camera"])
    first = rows[0]
    moved = [[*row["motion"]["velocity_px_s"], row["motion"]["roll_rad_s"]] for row in rows]
    return (np.array([row["running_time_ns"] * 1e-9 for row in rows]), np.array(moved),
            (first["width_px"], first["height_px"]))


def by_dense_flow(film, times_s, size):
    """Rates of the frames, of a homography that is fitted robustly to DIS."""
    width, height = size
    decoded = subprocess.Popen(["ffmpeg", "-loglevel", "error", "-i", film, "-vf", f"scale={width}:{height}", "-vsync",
                                "passthrough", "-f", "rawvideo", "-pix_fmt", "gray", "-"], stdout=subprocess.PIPE)
    dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    y, x = np.mgrid[GRID_PX // 2:height:GRID_PX, GRID_PX // 2:width:GRID_PX]
    points = np.stack([x.ravel(), y.ravel()], 1).astype(np.float32)
    middle, before, rates = np.array([width / 2, height / 2]), None, []
    while len(data := decoded.stdout.read(width * height)) == width * height:
        now = np.frombuffer(data, np.uint8).reshape(height, width)
        rate = np.zeros(3)
        if before is not None:
            flow = dis.calc(before, now, None)
            moved = points + flow[y.ravel(), x.ravel()]
            homography, _ = cv2.findHomography(points - middle, moved - middle, cv2.RANSAC, INLIER_PX * height / 480)
            if homography is not None:
                h = homography / homography[2, 2]
                shift = h[:2, 2]
                linear = h[:2, :2] - np.outer(shift, h[2, :2])  # the derivative in the middle
                roll = np.arctan2(linear[1, 0] - linear[0, 1], linear[0, 0] + linear[1, 1])
                seconds = times_s[len(rates)] - times_s[len(rates) - 1]
                rate = -np.array([*shift, roll]) / seconds
        rates.append(rate)
        before = now
    decoded.wait()
    return np.array(rates)


def between(times_s, gyro_s, gyro, lag_s):
    """Mean rates of the gyroscope between each frame and the one before it; NaN outside of what it covers."""
    angle = np.concatenate([np.zeros((1, 3)), np.cumsum(0.5 * (gyro[1:] + gyro[:-1]) * np.diff(gyro_s)[:, None], axis=0)])
    at = times_s + lag_s
    there = np.stack([np.interp(at, gyro_s, angle[:, axis], np.nan, np.nan) for axis in range(3)], 1)
    return np.concatenate([np.full((1, 3), np.nan), np.diff(there, axis=0) / np.diff(times_s)[:, None]])


def correlation(p, q):
    p, q = p - p.mean(), q - q.mean()
    return (p * q).sum() / max(np.sqrt((p * p).sum() * (q * q).sum()), 1e-30)


class Fit:
    """The lag, axes, signs and focal length with which the gyroscope explains most of what was measured.

    `measured`: of each method, rates of the frames. `known`: the frames to fit with."""

    def __init__(self, times_s, gyro_s, gyro, measured, known):
        most = -1.0
        for lag_s in np.arange(-LAGS_S, LAGS_S + LAG_STEP_S / 2, LAG_STEP_S):
            rates = between(times_s, gyro_s, gyro, lag_s)
            good = known & ~np.isnan(rates[:, 0])
            turned = rates[good] - rates[good].mean(axis=0)
            products = sum(each[good].T @ turned for each in measured)  # of each axis of the camera and the gyroscope
            squares = len(measured) * (turned**2).sum(axis=0)
            for axes in map(list, permutations(range(3))):
                both = np.abs(products[range(3), axes])[:2].sum()
                explained = both**2 / squares[axes[:2]].sum()
                if explained > most:
                    most, self.lag_s, self.axes = explained, lag_s, axes
                    self.signs = np.sign(products[range(3), axes])
                    self.focal_px = both / squares[axes[:2]].sum()
        self.rates = between(times_s, gyro_s, gyro, self.lag_s)[:, self.axes] * self.signs


def describe(true, found):
    """r, slope and error in degrees/s."""
    slope = ((true - true.mean()) * (found - found.mean())).sum() / ((true - true.mean())**2).sum()
    return correlation(true, found), slope, np.degrees(np.sqrt(((found - true)**2).mean()))


def with_interval(true, found, frames_a_block):
    """The three figures, and 95 % intervals over blocks of frames."""
    random = np.random.default_rng(1)
    blocks = np.array_split(np.arange(len(true)), max(2, len(true) // frames_a_block))
    drawn = [np.concatenate([blocks[n] for n in random.integers(len(blocks), size=len(blocks))]) for _ in range(RESAMPLES)]
    sampled = np.array([describe(true[each], found[each]) for each in drawn])
    return list(zip(describe(true, found), *np.percentile(sampled, (2.5, 97.5), axis=0)))


def report(name, times_s, gyro_s, gyro, measured):
    """Rows of the table of one film."""
    started = np.arange(len(times_s)) >= 2  # the first frames have no motion yet
    fit = Fit(times_s, gyro_s, gyro, list(measured.values()), started)
    judged = started & ~np.isnan(fit.rates[:, 0])
    frames_a_block = max(1, round(BLOCK_S / np.median(np.diff(times_s))))
    lines = [f"{name}: {judged.sum()} frames judged, f = {fit.focal_px:.0f} px, lag {1000 * fit.lag_s:.0f} ms, columns of the gyroscope: "
             + ", ".join(f"{axis} {'-' if sign < 0 else ''}{n + 1}"
                         for axis, n, sign in zip(AXES, fit.axes, fit.signs)), "",
             "| axis | method | r | slope | error, degrees/s | gyroscope, degrees/s |", "|---" * 6 + "|"]
    for n, axis in enumerate(AXES):
        for method, rates in measured.items():
            true, found = fit.rates[judged, n], rates[judged, n] / (fit.focal_px if n < 2 else 1)
            r, slope, error = (f"{value:.3f} ({low:.3f} to {high:.3f})"
                               for value, low, high in with_interval(true, found, frames_a_block))
            lines.append(f"| {axis} | {method} | {r} | {slope} | {error} | {np.degrees(true.std()):.2f} |")
    return "\n".join(lines) + "\n"


def films_in(folder, scratch):
    """Name, film, times of its frames (nothing: those of the film), times and rates of the gyroscope."""
    for film in sorted(folder.rglob("*.mp4")):
        gyro = read_gopro(film)
        if gyro:
            yield film.name, film, None, *gyro
    for stamps in sorted(folder.rglob("framestamp.txt")):
        film, times_s, gyro_s, gyro = read_pictures(stamps.parent, scratch / f"{stamps.parent.name}.mkv")
        yield stamps.parent.name, film, times_s, gyro_s, gyro


def main():
    if len(sys.argv) < 2:
        print("skipped: no folder; usage: tests/bench/gyroscope.py FOLDER...")
        return
    if not cv2:
        sys.exit("gyroscope.py: needs OpenCV for Python (python3-opencv), for the interpreter that runs it")
    build = Path(os.environ.get("BUILD", "build")).resolve()
    found = 0
    with tempfile.TemporaryDirectory() as scratch:
        for folder in map(Path, sys.argv[1:]):
            if not folder.is_dir():
                sys.exit(f"gyroscope.py: {folder} is not a folder")
            for name, film, times_s, gyro_s, gyro in films_in(folder, Path(scratch)):
                shown_s, rates, size = by_element(build, film)
                times_s = shown_s if times_s is None else times_s[:len(shown_s)]
                # The trace's rates are those of the film's times.
                rates[1:, :] *= (np.diff(shown_s) / np.diff(times_s))[:, None]
                dense = by_dense_flow(film, times_s, size)[:len(times_s)]
                print(report(name, times_s, gyro_s, gyro, dict(zip(METHODS, (rates, dense)))), flush=True)
                found += 1
    if not found:
        sys.exit("gyroscope.py: no film with a gyroscope in " + ", ".join(sys.argv[1:]))


if __name__ == "__main__":
    main()
