# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Scenes: what is behind everything, a ground, walls, and what stands in them. restless.py and objects.py add what
moves."""

import cv2
import numpy as np

import restless
from motions import ripple
from shares import SCENE, SCENERY, TEXTURE, choose, log_uniform
from surfaces import RESTLESS, STILL, Relief, Surface
from textures import cloud, gradient, outline, texture


class Scene:
    """Makes the surfaces of one film."""

    def __init__(self, rng, bank, size, frames):
        self.rng, self.bank, self.frames = rng, bank, frames
        self.w, self.h = size
        self.f = rng.uniform(0.7, 2.6) * self.w
        self.kind = choose(rng, SCENE)
        self.surfaces = []
        self.targets = []  # of each object: where it is at a time
        self.owner = 0
        self.far = {
            "flat": 100,
            "plain": rng.uniform(4, 60),
            "open": rng.uniform(40, 120),
            "room": rng.uniform(5, 14),
            "clutter": rng.uniform(4, 14),
            "relief": rng.uniform(3, 12),
            "near": rng.uniform(6, 80),
        }[self.kind]

    def texture(self, h, w, plain=1.0):
        kinds = {k: v * (plain if k in ("plain", "shaded") else 1) for k, v in TEXTURE.items()}
        return texture(self.rng, self.bank, int(np.clip(h, 16, 700)), int(np.clip(w, 16, 1000)), kinds)

    def backdrop(self):
        """What is behind everything."""
        rng, far = self.rng, self.far
        extra = 2.0 if self.kind != "flat" else 1.7
        w, h = extra * self.w / self.f * far, extra * self.h / self.f * far
        th, tw = int(self.h * extra), int(self.w * extra)
        if self.kind == "plain":
            grey = np.clip(gradient(rng, th, tw, rng.uniform(0, 60)), 0, 255)
            if rng.random() < 0.5:  # hardly any texture
                grey = np.clip(
                    grey + (cloud(rng, th, tw, rng.uniform(1, 2)).astype(np.float32) - 128) * rng.uniform(0.01, 0.12),
                    0,
                    255,
                )
            grey = grey.astype(np.uint8)
        else:
            grey = self.texture(th, tw, 0.25)
        tilt = rng.normal(0, 0.25) if self.kind != "flat" else 0
        self.surfaces.append(
            Surface(grey, None, [-w / 2, -h / 2, far - tilt * w / 2], [w, 0, tilt * w], [0, h, 0], 1e6)
        )

    def ground(self, wet):
        rng = self.rng
        y = rng.uniform(0.8, 2.0)
        grey = self.texture(500, 900, 0.3)
        edges = np.concatenate([[0.5], np.geomspace(1.4, min(self.far, 80), 6)])
        wave, speed = ripple(rng, (120, 900)) if wet else (None, 0)
        for i, (z0, z1) in enumerate(zip(edges[:-1], edges[1:])):
            strip = grey[70 * i % 400 : 70 * i % 400 + 90]
            self.surfaces.append(
                Surface(
                    strip,
                    None,
                    [-30, y, z1],
                    [60, 0, 0],
                    [0, 0, z0 - z1],
                    1e5 - z0,
                    RESTLESS if wet else STILL,
                    wave=wave,
                    wave_px=speed,
                )
            )

    def scenery(self):
        """The scene with all that stands in it."""
        rng, kind = self.rng, self.kind
        special = choose(rng, SCENERY)
        if kind == "relief":
            ny = int(rng.choice([6, 8, 10, 13]))  # coarse to rocky
            nx = int(1.5 * ny)
            rough = (
                cv2.resize(
                    cloud(rng, 64, 64, rng.uniform(0.8, 2)).astype(np.float32) - 128,
                    (nx, ny),
                    interpolation=cv2.INTER_AREA,
                )
                / 45
            )
            slope = rng.normal(0, 0.7) if rng.random() < 0.3 else -abs(rng.normal(0, 1.0))
            depths = self.far * np.exp(
                rng.uniform(0.03, 0.4) * rough
                + slope * np.linspace(-0.5, 0.5, ny)[:, None]
                + rng.normal(0, 0.3) * np.linspace(-0.5, 0.5, nx)[None]
            )
            if rng.random() < 0.35:  # steps, as of houses
                depths = self.far * np.exp(np.round(np.log(depths / self.far) / 0.3) * 0.3)
            self.surfaces.append(
                Relief(self.texture(int(self.h * 1.2), int(self.w * 1.2), 0.1), depths, self.f, (self.w, self.h))
            )
            self.far = float(np.median(depths))
        else:
            self.backdrop()
        if kind in ("open", "room"):
            self.ground(special == "water")
        if kind == "room" and rng.random() < 0.6:
            x = rng.choice([-1, 1]) * rng.uniform(1.5, 4)
            self.surfaces.append(Surface(self.texture(300, 600), None, [x, -3, 1.5], [0, 0, self.far], [0, 6, 0], 9e4))
        low, high = {
            "plain": (0, 3),
            "flat": (0, 2),
            "open": (1, 10),
            "room": (2, 10),
            "clutter": (5, 18),
            "relief": (0, 5),
            "near": (0, 5),
        }[kind]
        for _ in range(int(rng.integers(low, high))):
            z = (
                rng.uniform(3, 40)
                if kind in ("open", "near", "plain", "flat")
                else rng.uniform(1.8, 0.95 * min(self.far, 12))
            )
            self.still_thing(min(z, 0.95 * self.far), log_uniform(rng, 24, 0.8 * self.h))
        if kind == "near":
            self.foreground()
        restless.add(self, special)

    def foreground(self):
        """Something close to the lens: anywhere, or rocks, a hedge, a sill along a side of the picture."""
        rng = self.rng
        z = rng.uniform(0.8, 0.4 * max(self.far, 3))
        if rng.random() < 0.4:
            return self.still_thing(z, log_uniform(rng, 0.3 * self.h, 1.3 * self.h))
        side = choose(rng, {"below": 3, "left": 1, "right": 1})
        for _ in range(int(rng.integers(1, 6))):
            along, across = rng.uniform(-0.55, 0.55), rng.uniform(0.4, 0.62)
            at = {"below": (along, across), "left": (-across, along), "right": (across, along)}[side]
            self.still_thing(z * rng.uniform(0.95, 1.05), log_uniform(rng, 0.15 * self.h, 0.7 * self.h), at=at)

    def still_thing(self, z, px, restless=False, at=None):
        """`at`: where its middle is, in pictures from the middle."""
        rng = self.rng
        h = px * z / self.f
        w = h * np.exp(rng.normal(-0.2, 0.6))
        x, y = (rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6)) if at is None else at
        x, y = x * self.w * z / self.f, y * self.h * z / self.f
        if self.bank.cutouts and rng.random() < 0.3 and not restless:
            grey, alpha = self.bank.cutouts[rng.integers(len(self.bank.cutouts))]
            w = h * grey.shape[1] / grey.shape[0]
        else:
            th, tw = int(np.clip(px, 32, 400)), int(np.clip(px * w / h, 32, 400))
            grey = self.texture(th, tw)
            alpha = outline(rng, *grey.shape)
        slant = rng.normal(0, 0.3) if self.kind not in ("open", "plain") else 0
        wave, speed = ripple(rng, grey.shape) if restless else (None, 0)
        self.surfaces.append(
            Surface(
                grey,
                alpha,
                [x - w / 2, y - h / 2, z - slant * w / 2],
                [w, 0, slant * w],
                [0, h, 0],
                z,
                RESTLESS if restless else STILL,
                wave=wave,
                wave_px=speed,
            )
        )

    def add(self, *surfaces):
        for surface in surfaces:
            self.owner = min(self.owner + 1, 200)  # each part by itself: of a swinging limb more moves than of the body
            surface.owner = self.owner
            self.surfaces.append(surface)
