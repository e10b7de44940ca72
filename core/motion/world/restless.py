# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What moves in a scene although a viewer would not call it an object."""

import cv2
import numpy as np

from motions import path, ripple
from shares import log_uniform
from surfaces import IGNORED, RESTLESS, Surface
from textures import cloud, outline


def water(scene):
    if scene.kind in ("open", "room"):
        return  # its ground is wet
    z = 0.93 * scene.far
    w, h = 2.2 * scene.w * z / scene.f, scene.rng.uniform(0.3, 1.2) * scene.h * z / scene.f
    grey = scene.texture(int(0.7 * scene.h), int(1.5 * scene.w), 0.3)
    wave, speed = ripple(scene.rng, grey.shape)
    scene.surfaces.append(
        Surface(
            grey,
            None,
            [-w / 2, scene.rng.uniform(-0.2, 0.3) * h, z],
            [w, 0, 0],
            [0, h, 0],
            z,
            RESTLESS,
            wave=wave,
            wave_px=speed,
        )
    )


def leaves(scene):
    for _ in range(int(scene.rng.integers(1, 5))):
        scene.still_thing(
            scene.rng.uniform(2, 0.95 * max(2.5, min(scene.far, 15))),
            log_uniform(scene.rng, 0.2 * scene.h, 0.9 * scene.h),
            restless=True,
        )


def smoke(scene):
    """Soft puffs that drift and change."""
    rng = scene.rng
    for _ in range(int(rng.integers(1, 4))):
        z = rng.uniform(2, 0.9 * max(2.5, min(scene.far, 15)))
        px = log_uniform(rng, 0.2 * scene.h, 0.9 * scene.h)
        n = 96
        y, x = np.mgrid[-1 : 1 : n * 1j, -1 : 1 : n * 1j]
        alpha = np.clip((1 - np.hypot(x, y)) * cloud(rng, n, n, 1.6) * rng.uniform(0.6, 1.6), 0, 255).astype(np.uint8)
        wave, speed = ripple(rng, (n, n))
        s = px * z / scene.f
        o = [rng.uniform(-0.5, 0.4) * scene.w * z / scene.f, rng.uniform(-0.5, 0.3) * scene.h * z / scene.f, z]
        grey = cloud(rng, n, n, 1.4) // 2 + np.uint8(rng.integers(60, 120))
        scene.surfaces.append(
            Surface(
                grey,
                alpha,
                o,
                [s, 0, 0],
                [0, s, 0],
                z,
                IGNORED,
                path=path(rng, 0.1 * z / scene.f, scene.frames, "straight"),
                wave=wave,
                wave_px=speed,
            )
        )


def crowd(scene):
    """Many small things that move each in its way; a viewer watches none of them."""
    rng = scene.rng
    z = rng.uniform(0.5, 0.9) * scene.far
    y0 = rng.uniform(-0.4, 0.2)
    for _ in range(int(rng.integers(20, 50))):
        px = rng.uniform(0.06, 0.16) * scene.h
        s = px * z / scene.f
        x, y = rng.uniform(-0.55, 0.55) * scene.w * z / scene.f, rng.uniform(y0, y0 + 0.35) * scene.h * z / scene.f
        grey = scene.texture(32, 24, 0.5)
        scene.surfaces.append(
            Surface(
                grey,
                outline(rng, *grey.shape),
                [x, y, z],
                [0.7 * s, 0, 0],
                [0, s, 0],
                z - 0.001 * y,
                IGNORED,
                path=path(rng, 0.15 * z / scene.f, scene.frames, "wander"),
                wave=lambda grey, t: grey,
            )
        )


def screen(scene):
    """A screen in the scene on which something moves."""
    rng = scene.rng
    z = rng.uniform(2, 0.9 * max(2.5, min(scene.far, 12)))
    h = rng.uniform(0.2, 0.5) * scene.h * z / scene.f
    w = 1.6 * h
    inner = scene.texture(120, 400, 0.2)
    speed = rng.normal(0, 4)
    wave = lambda grey, t: np.roll(grey, int(speed * t * grey.shape[1] / 200), 1)
    o = [rng.uniform(-0.4, 0.2) * scene.w * z / scene.f, rng.uniform(-0.4, 0.1) * scene.h * z / scene.f, z]
    scene.surfaces.append(
        Surface(inner[:, :200].copy(), None, o, [w, 0, 0], [0, h, 0], z, RESTLESS, wave=wave, wave_px=abs(speed))
    )


def shadow(scene):
    rng = scene.rng
    z = 0.97 * scene.far
    s = rng.uniform(0.2, 0.7) * scene.h * z / scene.f
    alpha = cv2.GaussianBlur(outline(rng, 96, 96, "blob"), (0, 0), rng.uniform(1, 6))
    o = [rng.uniform(-0.5, 0.3) * scene.w * z / scene.f, rng.uniform(-0.4, 0.2) * scene.h * z / scene.f, z]
    scene.surfaces.append(
        Surface(
            np.zeros((96, 96), np.uint8),
            alpha,
            o,
            [s, 0, 0],
            [0, s, 0],
            z,
            IGNORED,
            path=path(rng, 0.5 * z / scene.f, scene.frames),
        )
    )


def add(scene, kind):
    """Adds scenery of a kind of shares.SCENERY to a scene."""
    if kind != "none":
        {"water": water, "leaves": leaves, "smoke": smoke, "crowd": crowd, "screen": screen, "shadow": shadow}[kind](
            scene
        )
