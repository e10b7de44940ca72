#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""test_world.py WORLD: the truth of rendered films is that of their pictures. WORLD is core/motion/world."""

import sys

try:
    import cv2
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; apt-get install python3-opencv python3-numpy")
    sys.exit(77)

sys.path.insert(0, sys.argv.pop(1))
import unittest

import shares
from film import Film, Noise, sample
from textures import cloud

SIZE, FRAMES = (320, 240), 6
NOTHING = {"none": 1}


class Photographs:
    """Made ones, since those of Debian's packages may not be there."""

    photos = [cloud(np.random.default_rng(k), 300, 400, 1) for k in range(3)]
    cutouts = []


class Worlds(unittest.TestCase):
    def setUp(self):
        self.usual = {name: getattr(shares, name) for name in dir(shares) if name.isupper()}
        self.addCleanup(lambda: [setattr(shares, name, value) for name, value in self.usual.items()])
        self.noise = Noise(np.random.default_rng(0))
        for name, only in {
            "SIZES": {SIZE: 1},
            "CAMERA": {"rest": 1},
            "SCENE": {"flat": 1},
            "SCENERY": NOTHING,
            "GRAPHICS": NOTHING,
        }.items():
            self.only(name, only)
        for name in ("MOTION_BLUR", "DEFOCUS", "LENS", "INTERLACED", "MJPEG", "LOW_CONTRAST", "EXPOSURE", "FLICKER"):
            setattr(shares, name, 0)

    def only(self, name, table):
        # The modules that imported a table hold the same dictionary.
        held = getattr(shares, name)
        before = dict(held)
        self.addCleanup(lambda: (held.clear(), held.update(before)))
        held.clear()
        held.update(table)

    def film(self, seed):
        rng = np.random.default_rng(seed)
        film = Film(rng, Photographs, SIZE, FRAMES)
        return film, *sample(rng, film, self.noise)

    def test_the_same_seed_gives_the_same_film(self):
        self.assertTrue(np.array_equal(self.film(5)[1], self.film(5)[1]))
        self.assertFalse(np.array_equal(self.film(5)[1], self.film(6)[1]))

    def test_without_objects_nothing_moves(self):
        self.only("OBJECTS", {0: 1})
        for seed in range(8):
            film, pictures, labels = self.film(seed)
            self.assertEqual(labels[..., 0].max(), 0)
            self.assertEqual(labels[..., 2].min(), 1)
            self.assertTrue(all(np.array_equal(film.frames[0], frame) for frame in film.frames))

    def test_where_the_truth_says_motion_pixels_change(self):
        self.only("OBJECTS", {1: 1})
        self.only("OBJECT", {"blob": 1})
        self.only("PATH", {"straight": 1})
        moving = 0
        for seed in range(12):
            film, _, _ = self.film(seed)
            for k in range(1, FRAMES):
                before, now = film.frames[k - 1].astype(int), film.frames[k].astype(int)
                still = (film.owners[k] == 0) & (film.owners[k - 1] == 0)
                # Up to half of a soft edge belongs to what is behind it.
                edges = cv2.dilate((~still).astype(np.uint8), np.ones((5, 5))) > 0
                self.assertEqual(np.abs(now - before)[~edges].max(initial=0), 0, f"seed {seed}, frame {k}")
                inside = film.moves[k][film.owners[k]]
                moving += np.abs(now - before)[inside].mean() > 0.5 if inside.any() else 0
        self.assertGreater(moving, 12)

    def test_an_object_moves_where_the_truth_says_so(self):
        self.only("OBJECTS", {1: 1})
        self.only("OBJECT", {"ball": 1})
        self.only("PATH", {"straight": 1})
        compared = 0
        for seed in range(20):
            film, _, _ = self.film(seed)
            inside = [(owners > 0).astype(np.uint8) for owners in film.owners]
            m = [cv2.moments(i, binaryImage=True) for i in inside]
            touches = any(i[0].any() or i[-1].any() or i[:, 0].any() or i[:, -1].any() for i in inside)
            if touches or min(a["m00"] for a in m) < 50:
                continue
            middles = np.array([(a["m10"] / a["m00"], a["m01"] / a["m00"]) for a in m])
            steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
            says_moves = film.moves[1:, 1]
            # A centroid of at least 50 pixels is right to a tenth of a pixel.
            self.assertTrue((steps[says_moves] > 0.05).all(), f"seed {seed}: {steps}")
            self.assertTrue((steps[~says_moves] < 0.35).all(), f"seed {seed}: {steps}")
            compared += 1
        self.assertGreater(compared, 3)

    def test_graphics_stay_while_the_camera_moves(self):
        self.only("OBJECTS", {0: 1})
        self.only("CAMERA", {"pan": 1})
        self.only("GRAPHICS", {"bars": 1})
        self.only("NOISE", {0.0: 1})
        for seed in range(4):
            _, pictures, labels = self.film(seed)
            whole = np.kron(labels[-1, :, :, 3] == 1, np.ones((16, 16), bool))
            self.assertTrue(whole.any())
            h, w = whole.shape
            top, left = (SIZE[1] - h) // 2, (SIZE[0] - w) // 2
            parts = [p[top : top + h, left : left + w][whole] for p in pictures]
            self.assertTrue(all(np.array_equal(parts[0], part) for part in parts))


if __name__ == "__main__":
    unittest.main()
