# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""How the camera of a film moves."""

import cv2
import numpy as np

from motions import smooth_walk
from shares import CAMERA, choose, log_uniform


def rotation(pan, tilt, roll):
    return (
        cv2.Rodrigues(np.array([0, 0, float(roll)]))[0]
        @ cv2.Rodrigues(np.array([float(tilt), 0, 0]))[0]
        @ cv2.Rodrigues(np.array([0, float(pan), 0]))[0]
    )


class Camera:
    """`at(t)` is its rotation, its place and its focal length in px at time t, in frames."""

    def __init__(self, rng, f, scene_kind, far, frames, target):
        """`target(t)` is the place of the object that it may follow; None: there is none."""
        mode = choose(rng, CAMERA)
        self.mode = "travel" if mode == "follow" and target is None else mode
        px = 1.0 / f  # the angle of a pixel
        self.t = t = np.arange(-1, frames + 2)
        n = len(t)
        self.f = f
        self.pan, self.tilt, self.roll, self.c, self.zoom = (
            np.zeros(n),
            np.zeros(n),
            np.zeros(n),
            np.zeros((n, 3)),
            np.ones(n),
        )
        self.is_still = self.mode == "rest"
        if self.is_still:
            return
        if self.mode == "pan" or (self.mode in ("zoom", "travel") and rng.random() < 0.35):
            speed = log_uniform(rng, 0.2, 18) * px
            a = rng.normal(0, 0.4) if rng.random() < 0.8 else rng.uniform(0, 6.3)
            s = np.cumsum(speed * (1 + 0.5 * np.sin(rng.uniform(0, 6.3) + t * rng.uniform(0, 0.3))))
            if rng.random() < 0.15:  # it begins or ends to turn
                s = np.maximum(s, s[rng.integers(n)])
            s = (s - s[n // 2]) * rng.choice([-1, 1])
            self.pan, self.tilt = s * np.cos(a), s * np.sin(a)
        if self.mode == "zoom":
            self.zoom = np.exp((t - frames / 2) * rng.normal(0, 0.012))
        if self.mode == "roll":
            self.roll = (t - frames / 2) * rng.normal(0, 0.02)
        if self.mode in ("hand", "travel", "follow", "orbit") or rng.random() < 0.25:
            size = log_uniform(rng, 0.1, 6 if self.mode == "hand" else 2) * px
            width = int(rng.integers(1, 6))
            self.pan = self.pan + smooth_walk(rng, n, size, width)
            self.tilt = self.tilt + smooth_walk(rng, n, size * rng.uniform(0.3, 1), width)
            self.roll = self.roll + smooth_walk(rng, n, size * 0.5 * rng.random(), width)
        if self.mode == "hand":
            self.c += np.stack([smooth_walk(rng, n, rng.uniform(0, 0.012), 4) for _ in range(3)], 1)
        if self.mode in ("travel", "orbit") or (self.mode == "follow" and rng.random() < 0.5):
            self.travel(rng, scene_kind, far, frames)
        if self.mode == "follow":
            self.follow(rng, target)
        if rng.random() < 0.3:
            self.roll = self.roll + rng.normal(0, 0.05)

    def travel(self, rng, scene_kind, far, frames):
        t = self.t
        speed = log_uniform(rng, 0.004, 0.12) * (3 if scene_kind in ("open", "flat") else 1)
        style = 3 if self.mode == "orbit" else int(rng.integers(3))
        d = {0: [0, 0, 1], 1: [1, 0, 0], 2: [rng.normal(), rng.normal(0, 0.3), rng.normal()], 3: [1, 0, 0.2]}[style]
        d = np.array(d, float) / np.linalg.norm(d) * rng.choice([-1, 1])
        if style == 0 and scene_kind in ("open", "flat"):
            d = np.abs(d)
        along = (t - frames / 2) * speed * (1 + 0.3 * np.sin(0.2 * t))
        limit = 0.35 * far  # it does not run into the wall
        self.c += (limit * np.tanh(along / limit))[:, None] * d
        if style == 3:
            self.pan = self.pan - np.arctan2(self.c[:, 0], rng.uniform(0.3, 1.0) * far)
        if rng.random() < 0.3:  # steps
            self.c[:, 1] += 0.01 * np.sin(t * rng.uniform(0.3, 0.9))

    def follow(self, rng, target):
        lag, gain = rng.uniform(0, 0.6), rng.uniform(0.7, 1.05)
        p = np.array([target(k) for k in self.t]) - self.c
        z = np.maximum(p[:, 2], 0.5)
        want = np.stack([np.arctan2(p[:, 0], z), -np.arctan2(p[:, 1], z)], 1)
        now = want[0].copy()
        for k in range(len(self.t)):
            now += (1 - lag) * (want[k] - now)
            self.pan[k] -= gain * (now[0] - want[0, 0])
            self.tilt[k] -= gain * (now[1] - want[0, 1])

    def at(self, time):
        g = lambda z: np.interp(time, self.t, z)
        return (
            rotation(g(self.pan), g(self.tilt), g(self.roll)),
            np.array([g(self.c[:, j]) for j in range(3)]),
            self.f * g(self.zoom),
        )


def project(camera, p, size):
    """Where a place is in the picture, px, and its depth."""
    R, c, f = camera
    q = R @ (p - c)
    return np.array([f * q[0] / q[2] + size[0] / 2, f * q[1] / q[2] + size[1] / 2]) if q[2] > 0.25 else None
