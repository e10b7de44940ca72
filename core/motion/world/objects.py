# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Objects, which move by themselves."""

import cv2
import numpy as np

from motions import path, ripple
from shares import AREA, OBJECT, choose, log_uniform
from surfaces import Surface
from textures import outline


def add(scene, largest):
    """An object that moves by itscene."""
    rng = scene.rng
    kind = choose(rng, OBJECT)
    z = (
        rng.uniform(2, 30)
        if scene.kind in ("flat", "open", "plain")
        else rng.uniform(1.6, 0.9 * max(2.0, min(scene.far, 12)))
    )
    z = min(z, 0.9 * scene.far)
    area = log_uniform(rng, AREA[0], largest)
    aspect = 1 if kind in ("ball", "wheel") else np.exp(rng.normal(0, 0.4))
    px = np.sqrt(area * scene.w * scene.h / aspect)
    unit = z / scene.f
    w, h = aspect * px * unit, px * unit
    x, y = rng.uniform(-0.45, 0.45) * scene.w * unit, rng.uniform(-0.42, 0.42) * scene.h * unit
    at = path(rng, unit, scene.frames)
    th, tw = int(np.clip(px * 1.2, 24, 400)), int(np.clip(px * aspect * 1.2, 24, 500))
    o, u, v = [x - w / 2, y - h / 2, z], [w, 0, 0], [0, h, 0]
    scene.targets.append(lambda t: np.array([x, y, z]) + at(t))
    joint = np.array([x, y, z])
    if kind == "cutout" and scene.bank.cutouts:
        grey, alpha = scene.bank.cutouts[rng.integers(len(scene.bank.cutouts))]
        if rng.random() < 0.5:
            grey, alpha = grey[:, ::-1].copy(), alpha[:, ::-1].copy()
        turn = (joint, rng.uniform(0, 0.3), rng.uniform(0.1, 0.6), rng.uniform(0, 6.3)) if rng.random() < 0.3 else None
        scene.add(Surface(grey, alpha, o, u, v, z, path=at, turn=turn))
    elif kind == "ball":
        n = int(np.clip(px * 1.5, 32, 300))
        yy, xx = np.mgrid[-1 : 1 : n * 1j, -1 : 1 : n * 1j]
        soft = rng.uniform(0.02, 0.1) if rng.random() < 0.5 else rng.uniform(0.1, 0.9)
        alpha = np.clip((0.97 - np.hypot(xx, yy)) / soft, 0, 1) * 255
        level, shade = rng.uniform(20, 235), rng.uniform(0, 60) if rng.random() < 0.5 else 0
        grey = np.clip(level + shade * (-0.6 * xx - 0.7 * yy), 0, 255).astype(np.uint8)
        scene.add(Surface(grey, alpha.astype(np.uint8), o, u, v, z, path=at))
    elif kind == "wheel":
        grey = scene.texture(th, th, 0.1)
        grey = cv2.resize(grey, (th, th))
        scene.add(
            Surface(
                grey,
                outline(rng, th, th, "ellipse"),
                o,
                u,
                v,
                z,
                path=at if rng.random() < 0.6 else None,
                spin=(joint, rng.normal(0, 0.15)),
            )
        )
    elif kind == "face":
        grey = scene.texture(th, tw, 0.3)
        little = path(rng, 0.12 * unit, scene.frames, "wander")
        mouth = scene.texture(32, 48, 0.3)
        scene.add(Surface(grey, outline(rng, *grey.shape, "ellipse"), o, u, v, z, path=little))
        yawn = rng.uniform(0.3, 0.9)
        beat = lambda t: little(t) + np.array([0, 0.03 * h * np.sin(yawn * t), 0])
        scene.add(
            Surface(
                mouth,
                outline(rng, *mouth.shape, "ellipse"),
                [x - 0.2 * w, y + 0.12 * h, z],
                [0.4 * w, 0, 0],
                [0, 0.2 * h, 0],
                z - 0.01,
                path=beat,
            )
        )
    elif kind == "cloth":
        grey = scene.texture(th, tw, 0.2)
        wave, speed = ripple(rng, grey.shape)
        scene.add(
            Surface(
                grey,
                outline(rng, *grey.shape, "box"),
                o,
                u,
                v,
                z,
                path=at if rng.random() < 0.5 else None,
                wave=wave,
                wave_px=speed,
            )
        )
    elif kind == "box":
        for k in range(int(rng.integers(2, 5))):
            grey = scene.texture(th, max(24, tw // 2), 0.5)
            slant = rng.normal(0, 0.8)
            ww = w * rng.uniform(0.3, 0.7)
            scene.add(
                Surface(
                    grey,
                    outline(rng, *grey.shape, "box"),
                    [x - w / 2 + k * 0.25 * w, y - h / 2 * rng.uniform(0.6, 1), z],
                    [ww, 0, slant * ww],
                    [0, h * rng.uniform(0.6, 1), 0],
                    z - 0.01 * k,
                    path=at,
                )
            )
    else:
        grey = scene.texture(th, tw, 0.8)
        alpha = outline(rng, *grey.shape)
        spin = (joint, rng.normal(0, 0.05)) if rng.random() < 0.2 else None
        scene.add(Surface(grey, alpha, o, u, v, z, path=at, spin=spin))
        for k in range(int(rng.integers(1, 5)) if kind == "limbs" else 0):
            limb = scene.texture(int(max(24, th * 0.7)), int(max(24, tw * 0.3)))
            lw, lh = 0.3 * w, rng.uniform(0.5, 0.9) * h
            lx, ly = x + rng.uniform(-0.5, 0.3) * w, y + rng.uniform(-0.3, 0.3) * h
            turn = (
                np.array([lx + lw / 2, ly, z]),
                rng.uniform(0.2, 1.0),
                rng.uniform(0.1, 0.8),
                rng.uniform(0, 6.3),
            )
            scene.add(
                Surface(
                    limb,
                    outline(rng, *limb.shape),
                    [lx, ly, z],
                    [lw, 0, 0],
                    [0, lh, 0],
                    z + (0.01 if k % 2 else -0.01),
                    path=at,
                    turn=turn,
                )
            )
