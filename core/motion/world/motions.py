# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""How things move and bend; times are in frames."""

import cv2
import numpy as np

from shares import PATH, SPEED_px, choose, log_uniform


def smooth_walk(rng, n, size, width):
    """A random path of n steps with a mean step of `size`, smooth over `width` frames; it begins at 0."""
    z = np.cumsum(rng.normal(size=n + 4 * width))
    z = np.convolve(z, np.hanning(2 * width + 1) / width, "same")[2 * width : 2 * width + n]
    return (z - z[0]) * size / max(np.abs(np.diff(z)).mean(), 1e-9)


def path(rng, unit, frames, kind=None):
    """How an object moves; `unit` is a pixel at its depth."""
    kind = kind or choose(rng, PATH)
    speed = log_uniform(rng, *SPEED_px) * unit
    angle = rng.normal(0, 0.5) + (np.pi if rng.random() < 0.5 else 0) if rng.random() < 0.7 else rng.uniform(0, 6.3)
    d = np.array([np.cos(angle), np.sin(angle), rng.normal(0, 0.6) if rng.random() < 0.3 else 0])
    begin, period, phase = rng.uniform(0, frames), rng.uniform(8, 50), rng.uniform(0, 6.3)
    bob = rng.uniform(0, 0.5) if rng.random() < 0.4 else 0
    if kind == "straight":
        return lambda t: speed * (d * t + np.array([0, bob * period / 6.3 * np.sin(12.6 * t / period + phase), 0]))
    if kind == "swing":
        return lambda t: speed * period / 6.3 * d * np.sin(6.3 * t / period + phase)
    if kind == "start":
        return lambda t: speed * d * max(0.0, t - begin)
    if kind == "stop":
        return lambda t: speed * d * min(t, begin)
    if kind == "thrown":
        g = rng.uniform(-0.1, 0.15) * speed
        return lambda t: speed * d * t + np.array([0, g, 0]) * (t - begin) ** 2 / 2
    if kind == "bounce":
        high = speed * period / 4
        return lambda t: speed * d * t * np.array([1, 0, 1]) - np.array(
            [0, high * abs(np.sin(np.pi * t / period + phase)), 0]
        )
    z = np.stack([smooth_walk(rng, frames + 4, speed, 4) for _ in range(2)] + [np.zeros(frames + 4)], 1)
    at = np.arange(-2, frames + 2)
    return lambda t: np.array([np.interp(t, at, z[:, j]) for j in range(3)])


def ripple(rng, shape, slow=1.0):
    """How a surface bends: waves that run through its texture. Returns the bend and its speed in px a frame."""
    size = rng.uniform(0.6, 3.5)
    length = rng.uniform(10, 90, 2)
    rate = rng.uniform(0.1, 0.9) * slow
    phase = rng.uniform(0, 6.3, 2)
    skew = rng.uniform(-1, 1, 2)

    def wave(grey, t):
        h, w = grey.shape
        k = w / shape[1]
        y, x = np.mgrid[0:h, 0:w].astype(np.float32)
        dx = k * size * np.sin((y + skew[0] * x) / (k * length[0]) + rate * t + phase[0])
        dy = k * size * np.sin((x + skew[1] * y) / (k * length[1]) - 0.8 * rate * t + phase[1])
        return cv2.remap(
            grey,
            (x + dx).astype(np.float32),
            (y + dy).astype(np.float32),
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REPLICATE,
        )

    return wave, size * rate
