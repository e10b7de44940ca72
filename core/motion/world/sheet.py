#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""sheet.py BANK PICTURE.png [SEED]: a contact sheet of the rendered world, with the truth. Red: moves by itself; blue:
graphics; violet: restless parts of the scene, which are no object; the rest is the still scene."""

import sys

import cv2
import numpy as np

from film import BLOCK_px, Film, Noise, sample
from textures import Bank

COLUMNS, ROWS, SIZE, FRAMES = 6, 4, (320, 240), 4


def tile(rng, bank, noise):
    film = Film(rng, bank, SIZE, FRAMES)
    pictures, labels = sample(rng, film, noise)
    moving, _, still, graphics = (
        np.kron(labels[-1, :, :, k].astype(np.float32), np.ones((BLOCK_px, BLOCK_px), np.float32)) for k in range(4)
    )
    image = cv2.cvtColor(pictures[-1], cv2.COLOR_GRAY2BGR).astype(np.float32)
    rest = np.clip(1 - moving - still - graphics, 0, 1)
    for weight, colour in ((moving, (40, 40, 255)), (graphics, (255, 90, 30)), (rest, (200, 60, 160))):
        image += 0.45 * weight[..., None] * (np.float32(colour) - image)
    image = image.astype(np.uint8)
    cv2.putText(
        image, f"{film.kinds[0]}, {film.kinds[1]}", (6, 16), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 3, cv2.LINE_AA
    )
    cv2.putText(
        image,
        f"{film.kinds[0]}, {film.kinds[1]}",
        (6, 16),
        cv2.FONT_HERSHEY_SIMPLEX,
        0.5,
        (255, 255, 255),
        1,
        cv2.LINE_AA,
    )
    return cv2.copyMakeBorder(image, 2, 2, 2, 2, cv2.BORDER_CONSTANT, value=(255, 255, 255))


def main():
    rng = np.random.default_rng(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    bank, noise = Bank(sys.argv[1], held=True), Noise(np.random.default_rng(0))
    rows = [np.hstack([tile(rng, bank, noise) for _ in range(COLUMNS)]) for _ in range(ROWS)]
    cv2.imwrite(sys.argv[2], cv2.resize(np.vstack(rows), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA))


if __name__ == "__main__":
    main()
