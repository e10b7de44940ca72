#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws what `washout` does to the force of a camera that pans: at once and for long, and to and fro.

    meson devenv -C build "$PWD/docs/figures/washout.py" FILE.png

Prints the time in which what lasts falls to 1/e, against 1 / (2 pi cut-off). Needs matplotlib (python3-matplotlib) and
rawvideoparse (gstreamer1.0-plugins-bad)."""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

WIDTH, HEIGHT, RATE_HZ, LENGTH_S = 320, 240, 30, 12
CUTOFFS_HZ = (0, 0.1, 0.3, 1)
TIMES_S = np.arange(LENGTH_S * RATE_HZ) / RATE_HZ
BEGIN_S, END_S, PAN_PX_S = 1, 8, 80
AFTER_PX_S = 8  # in a picture at rest nothing would be felt
SLOW_HZ, FAST_HZ, SWAY_PX_S = 0.1, 1, 80


def film(velocity_px_s):
    """A texture that is interpolated, as a camera sees it that moves to the right."""
    random = np.random.default_rng(1)
    waves = [(7, *random.uniform(-0.5, 0.5, 2), random.uniform(0, 7)) for _ in range(16)]
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    at_px = np.cumsum(velocity_px_s) / RATE_HZ
    grey = lambda left: sum(size * np.sin(a * (x + left) + b * y + phase) for size, a, b, phase in waves)
    return b"".join(np.uint8(np.clip(128.5 + grey(left), 0, 255)).tobytes() for left in at_px)


def forces_N(frames, cutoff_Hz):
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder, "trace.csv")
        command = (f"gst-launch-1.0 -q fdsrc ! rawvideoparse format=gray8 width={WIDTH} height={HEIGHT} "
                   f"framerate={RATE_HZ}/1 ! spidarmotion device=none motion=camera washout={cutoff_Hz} "
                   f"trace={trace} ! fakesink")
        subprocess.run(command.split(), input=frames, check=True)
        with open(trace, encoding="utf-8", newline="") as file:
            return np.array([float(row["force_x_N"]) for row in csv.DictReader(file)])


def main(path):
    step = film(np.select([TIMES_S < BEGIN_S, TIMES_S < END_S], [0, PAN_PX_S], AFTER_PX_S))
    sway = film(SWAY_PX_S * (np.sin(2 * np.pi * SLOW_HZ * TIMES_S) + np.sin(2 * np.pi * FAST_HZ * TIMES_S) / 2))
    figure, axes = pyplot.subplots(2, figsize=(11, 7), sharex=True)
    for cutoff_Hz in CUTOFFS_HZ:
        of_step = forces_N(step, cutoff_Hz)
        for axis, force_N in zip(axes, (of_step, forces_N(sway, cutoff_Hz))):
            axis.plot(TIMES_S, force_N, label=f"washout={cutoff_Hz}" if cutoff_Hz else "washout=0 (default)",
                      color="#b0b0b0" if not cutoff_Hz else None)
        if cutoff_Hz:
            begun = np.flatnonzero(of_step > 0.9 * of_step.max())[0]
            fallen = np.flatnonzero(of_step[begun:] < of_step[begun] / np.e)[0] / RATE_HZ
            print(f"washout={cutoff_Hz}: falls to 1/e in {fallen:.2f} s; 1 / (2 pi {cutoff_Hz}) is "
                  f"{1 / (2 * np.pi * cutoff_Hz):.2f} s")
    titles = (f"A pan from {BEGIN_S} to {END_S} s, and a slow one after it", f"A sway at {SLOW_HZ} Hz with one of half its size at {FAST_HZ} Hz")
    for axis, title in zip(axes, titles):
        axis.set(title=title, ylabel="force, N")
        axis.grid(color="#d8d8d8", linewidth=0.5)
        axis.legend(loc="upper right")
    axes[-1].set_xlabel("time, s")
    figure.tight_layout()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: washout.py FILE.png")
    main(sys.argv[1])
