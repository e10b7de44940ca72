#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""From pictures to a wrench: a textured square moves to the right over a textured background, 4 px in each of 25
pictures a second; prints the wrench that would be felt. Any bytes will do for a picture, also an array of NumPy."""

import signal

import gst_spidar

WIDTH, HEIGHT, SIDE = 320, 240, 96


def texture(x, y, seed):
    """A random grey that is the same for the same place, in spots of 3 × 3 pixels."""
    spot = x // 3 * 73 + y // 3 * 151 + seed
    return spot * 2654435761 % 2**32 >> 24


def picture(left, top):
    pixels = bytearray(texture(x, y, 0) for y in range(HEIGHT) for x in range(WIDTH))
    square = bytes(texture(x, y, 7) for y in range(SIDE) for x in range(SIDE))
    for y in range(SIDE):
        begin = (top + y) * WIDTH + left
        pixels[begin : begin + SIDE] = square[y * SIDE : (y + 1) * SIDE]
    return pixels


signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
motion = gst_spidar.MotionToWrench()
for frame in range(20):
    found = motion.analyze(picture(40 + 4 * frame, 72), WIDTH, HEIGHT, time_s=frame / 25)
    print(f"{found.velocity_x_px_s:.1f} px/s to the right: {found.wrench.force_N.x:.2f} N")
