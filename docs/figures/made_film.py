#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws the film of the screenshots: a ball bounces across a meadow while an airship flies by.

made_film.py SECONDS >FILM: raw frames, 848x480 RGB at 30 frames/s, which repeat every six seconds. Needs
python3-numpy."""

import sys

import numpy as np

WIDTH, HEIGHT, RATE, PERIOD_S = 848, 480, 30, 6
FLOOR = 408  # of the ball's lower edge, px
RADIUS = 46
BOUNCE_S, BOUNCE_PX = 1.5, 165

y_px, x_px = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)


def paint(picture, cover, color):
    """Lays a colour over the picture where `cover` is 1, half of it where it is 0.5."""
    picture += cover[..., None] * (np.asarray(color, float) - picture)


def edge(distance_px):
    """1 inside (distance < 0), 0 outside, soft over a pixel."""
    return np.clip(0.5 - distance_px, 0, 1)


def ellipse(x, y, a, b):
    return edge((np.hypot((x_px - x) / a, (y_px - y) / b) - 1) * min(a, b))


def hills(base, heights, lengths, phases):
    line = base + sum(h * np.sin(2 * np.pi * x_px / l + p) for h, l, p in zip(heights, lengths, phases))
    return edge(line - y_px)


def tree(picture, x, y, size):
    paint(picture, edge(np.maximum(np.abs(x_px - x) - 0.08 * size, np.abs(y_px - y + 0.2 * size) - 0.2 * size)),
          (98, 72, 56))
    for level in range(3):
        top = y - (1.15 - 0.28 * level) * size
        half = (0.16 + 0.1 * level) * size
        below = y_px - top
        inside = np.maximum(np.abs(x_px - x) - below * half / (0.42 * size), below - 0.42 * size)
        paint(picture, edge(inside), (52 + 8 * level, 104 - 8 * level, 78))


def landscape():
    random = np.random.default_rng(4)
    picture = np.empty((HEIGHT, WIDTH, 3))
    share = y_px[..., None] / HEIGHT
    picture[:] = (1 - share) * np.array([126, 184, 226]) + share * np.array([226, 240, 246])
    paint(picture, ellipse(700, 84, 38, 38), (255, 238, 186))
    for x, y, size in ((150, 92, 1.0), (470, 60, 0.8), (600, 130, 0.6)):
        for dx, dy, r in ((-40, 6, 24), (-12, -6, 34), (26, 0, 28), (52, 8, 18)):
            paint(picture, ellipse(x + size * dx, y + size * dy, 1.3 * size * r, size * r), (252, 253, 255))
    paint(picture, hills(250, (34, 16), (520, 190), (0.4, 1)), (148, 178, 190))
    paint(picture, hills(292, (22, 10), (430, 160), (2.1, 0)), (116, 158, 140))
    paint(picture, hills(342, (9, 4), (610, 210), (1, 2)), (112, 164, 84))
    for x, y, size in ((60, 352, 92), (118, 348, 64), (742, 352, 104), (806, 350, 70), (668, 344, 52)):
        tree(picture, x, y, size)
    meadow = hills(352, (9, 4), (610, 210), (1, 2))
    for _ in range(1300):  # blades and flowers
        x, y = random.uniform(0, WIDTH), random.uniform(352, HEIGHT)
        near = (y - 340) / 140
        i, k = int(y), int(x)
        blade = slice(max(i - int(2 + 8 * near), 0), i), slice(k, k + 1 + int(1.6 * near))
        color = (240, 224, 130) if random.random() < 0.06 else (84 + 40 * random.random(), 150, 66)
        picture[blade] += 0.75 * meadow[blade][..., None] * (np.array(color) - picture[blade])
    return picture


def draw_ball(picture, time_s):
    x = WIDTH / 2 + 280 * np.sin(2 * np.pi * time_s / PERIOD_S)
    step = time_s / BOUNCE_S % 1
    y = FLOOR - RADIUS - 4 * BOUNCE_PX * step * (1 - step)
    height = (FLOOR - RADIUS - y) / BOUNCE_PX
    shadow = ellipse(x, FLOOR + 6, RADIUS * (1 - 0.35 * height), 8)
    paint(picture, (0.34 - 0.2 * height) * shadow, (30, 60, 30))
    dx, dy = x_px - x, y_px - y
    cover = edge(np.hypot(dx, dy) - RADIUS)
    turn = (x - WIDTH / 2) / RADIUS / 6  # it turns
    sector = ((np.arctan2(dy, dx) - turn) / (2 * np.pi) * 6) % 6
    ball = np.array([(226, 62, 54), (250, 250, 246), (38, 118, 206), (250, 250, 246), (246, 190, 52),
                     (250, 250, 246)], float)[sector.astype(int) % 6]
    ball[np.hypot(dx, dy) < 0.2 * RADIUS] = (250, 250, 246)
    light = 1 - 0.3 * np.clip((dx + dy) / (2 * RADIUS) + 0.25, 0, 1)
    picture += cover[..., None] * (ball * light[..., None] - picture)


def draw_airship(picture, time_s):
    share = time_s / PERIOD_S % 1
    x, y = WIDTH + 80 - share * (WIDTH + 160), 62 + 10 * np.sin(2 * np.pi * share)
    fins = np.maximum(np.abs(x_px - x - 46) - 16, np.abs(y_px - y) - 0.6 * (x_px - x - 20))
    paint(picture, edge(fins), (178, 66, 52))
    paint(picture, edge(np.maximum(np.abs(x_px - x) - 16, np.abs(y_px - y - 25) - 5)), (70, 74, 92))
    hull = ellipse(x, y, 60, 23)
    paint(picture, hull, (86, 98, 136))
    for stripe in (-8, 8):
        paint(picture, hull * edge(np.abs(y_px - y - stripe) - 2.5), (236, 236, 240))


def main():
    background = landscape()
    for frame in range(int(float(sys.argv[1]) * RATE)):
        picture = background.copy()
        draw_airship(picture, frame / RATE)
        draw_ball(picture, frame / RATE)
        sys.stdout.buffer.write(np.clip(picture + 0.5, 0, 255).astype(np.uint8).tobytes())


if __name__ == "__main__":
    main()
