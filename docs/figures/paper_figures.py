#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws fig. 6 to 10 of the paper: the motion and the forces that spidarmotion measures of a bouncing ball.

    meson devenv -C build "$PWD/docs/figures/paper_figures.py" FOLDER

The true curves follow from the physics of the scene and eq. 11 to 15. Needs matplotlib (python3-matplotlib) and
rawvideoparse (gstreamer1.0-plugins-bad).
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

WIDTH, HEIGHT, RATE_HZ, LENGTH_S = 640, 480, 30, 6
RADIUS_PX, FALL_PX, FLOOR_PX = 40, 360, 460
GRAVITY_PX_S2, RESTITUTION = 1500, 0.85
MAX_FORCE_N = 3  # the default of max-force; the paper does not state Fmax
ALPHA_S_PX = 0.01  # the paper's (eq. 15), and the default of alpha with motion=mean; with others it is 0.0025


def height_and_velocity(time_s):
    """Of the ball's lower edge above the floor, px and px/s, upwards positive."""
    begin, height, up = 0.0, FALL_PX, 0.0
    impact = np.sqrt(2 * FALL_PX / GRAVITY_PX_S2)
    speed = GRAVITY_PX_S2 * impact
    while time_s >= impact:
        speed *= RESTITUTION
        begin, height, up = impact, 0.0, speed
        impact += 2 * speed / GRAVITY_PX_S2
    since = time_s - begin
    return height + up * since - GRAVITY_PX_S2 * since**2 / 2, up - GRAVITY_PX_S2 * since


def picture(time_s, texture):
    """The ball with its texture, which is interpolated, before a plain background."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    x -= WIDTH / 2
    y -= FLOOR_PX - RADIUS_PX - height_and_velocity(time_s)[0]
    cover = np.clip(RADIUS_PX + 0.5 - np.hypot(x, y), 0, 1)
    grey = sum(amplitude * np.sin(a * x + b * y + phase) for amplitude, a, b, phase in texture)
    return np.uint8(np.clip(128 + cover * grey + 0.5, 0, 255)).tobytes()


def film():
    random = np.random.default_rng(1)
    texture = [(14, *random.uniform(-0.5, 0.5, 2), random.uniform(0, 7)) for _ in range(16)]
    return b"".join(picture(n / RATE_HZ, texture) for n in range(LENGTH_S * RATE_HZ + 1))


def measure(frames, controller):
    """Times, velocities upwards and forces upwards of the frames that have a predecessor: s, px/s, N."""
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder, "trace.csv")
        command = (f"gst-launch-1.0 -q fdsrc ! rawvideoparse format=gray8 width={WIDTH} height={HEIGHT} "
                   f"framerate={RATE_HZ}/1 ! spidarmotion device=none motion=mean filter-min-cutoff=0 "
                   f"controller={controller} trace={trace} ! fakesink")
        subprocess.run(command.split(), input=frames, check=True)
        with open(trace, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))[1:]
    column = lambda name: np.array([float(row[name]) for row in rows])
    return 1e-9 * column("running_time_ns"), -column("velocity_y_px_s"), column("force_y_N")


def gain(velocity_px_s):
    """k = Fmax / Vmax(T) of the linear controller (eq. 12)."""
    return MAX_FORCE_N / np.maximum(np.maximum.accumulate(np.abs(velocity_px_s)), 1e-9)


def main(folder):
    frames = film()
    times_s, velocity, linear_N = measure(frames, "linear")
    nonlinear_N = measure(frames, "nonlinear")[2]
    middle_s = times_s - 0.5 / RATE_HZ  # a velocity is the mean of the interval before the frame
    position = FALL_PX + np.cumsum(velocity) / RATE_HZ
    fine_s = np.arange(0, LENGTH_S, 0.001)
    true_position, true_velocity = np.array([height_and_velocity(t) for t in fine_s]).T
    true_nonlinear_N = 2 * MAX_FORCE_N / np.pi * np.arctan(ALPHA_S_PX * true_velocity)

    def draw(name, title, *panels):
        figure, axes = pyplot.subplots(len(panels), figsize=(11, 1 + 3 * len(panels)), sharex=True, squeeze=False)
        figure.suptitle(title)
        for axis, (label, truth, measured) in zip(axes[:, 0], panels):
            axis.plot(*truth, ".", color="#b0b0b0", markersize=3, label="true")
            axis.plot(*measured, ".", color="#0b5fa5", label="measured")
            axis.set_ylabel(label)
            if "acceleration" in label:
                axis.set_ylim(-2 * GRAVITY_PX_S2, 0)
            axis.grid(color="#d8d8d8", linewidth=0.5)
            axis.legend(loc="upper right")
        axes[-1, 0].set_xlabel("speed V, px/s" if name == "fig9" else "time, s")
        figure.tight_layout()
        figure.savefig(Path(folder, name + ".png"), dpi=100)

    at = ("position, px", (fine_s, true_position), (times_s, position))
    draw("fig6", "Fig. 6: motion of a bouncing ball", at,
         ("velocity, px/s", (fine_s, true_velocity), (middle_s, velocity)),
         ("acceleration, px/s²\n(without impacts)", (fine_s, np.full_like(fine_s, -GRAVITY_PX_S2)),
          (times_s[:-1], np.where(np.diff(velocity) < 0, np.diff(velocity) * RATE_HZ, np.nan))))
    draw("fig7", "Fig. 7: gain k = Fmax / Vmax(T) of the linear controller",
         ("k, N per px/s", (fine_s[100:], gain(true_velocity)[100:]), (middle_s[3:], gain(velocity)[3:])))
    draw("fig8", "Fig. 8: force of the linear controller", at,
         ("force, N", (fine_s, gain(true_velocity) * true_velocity), (middle_s, linear_N)))
    draw("fig9", "Fig. 9: force of the nonlinear controller, (2 Fmax / π) atan(α V)",
         ("force, N", (np.abs(true_velocity), np.abs(true_nonlinear_N)), (np.abs(velocity), np.abs(nonlinear_N))))
    draw("fig10", "Fig. 10: force of the nonlinear controller", at,
         ("force, N", (fine_s, true_nonlinear_N), (middle_s, nonlinear_N)))
    true_step = np.diff([height_and_velocity(t)[0] for t in np.append(0, times_s)])
    error = velocity / RATE_HZ - true_step
    print(f"measured motion against the true one: {np.sqrt(np.mean(error**2)):.4f} px a frame rms, "
          f"{np.abs(error).max():.4f} at most")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: paper_figures.py FOLDER    fig6.png to fig10.png into it")
    main(sys.argv[1])
