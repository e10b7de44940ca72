# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What the rendered world contains, and how much of each. The numbers of a table are weights and need not sum to 1.
None of them was chosen on a real film."""

# Width and height of a film, px: sizes that the field of blocks takes as they are.
SIZES = {(432, 240): 50, (320, 240): 20, (352, 288): 12, (240, 432): 6, (480, 208): 6, (272, 368): 6}

OBJECTS = {0: 44, 1: 36, 2: 12, 3: 8}  # how many move by themselves

CAMERA = {
    "rest": 20,  # on a tripod
    "pan": 12,
    "hand": 17,  # held by somebody who stands
    "zoom": 6,
    "roll": 3,
    "travel": 20,  # drives, walks, flies
    "orbit": 6,  # around something near
    "follow": 16,  # keeps an object in the picture, with a lag
}

SCENE = {
    "plain": 14,  # ice, a wall, the sky, all of it out of focus
    "flat": 16,  # everything far away
    "open": 20,  # a ground and things on it
    "room": 16,
    "clutter": 14,  # many things at all depths
    "relief": 14,  # rough slopes, houses from the air
    "near": 14,  # something still, close to the lens
}

# Surfaces. "photo": a part of a photograph.
TEXTURE = {"photo": 62, "cloud": 10, "pattern": 8, "plain": 12, "shaded": 8}

OBJECT = {
    "cutout": 24,  # a photographed thing with its outline
    "blob": 22,  # a piece of some texture
    "ball": 18,  # plain or shaded, its edge sharp or out of focus
    "limbs": 12,  # a body with parts that swing
    "wheel": 5,  # turns in its plane
    "face": 7,  # its inside moves, its outline hardly
    "cloth": 6,  # waves
    "box": 6,  # several sides at several depths
}

PATH = {
    "straight": 40,
    "swing": 16,
    "start": 10,
    "stop": 10,
    "thrown": 9,
    "wander": 9,
    "bounce": 6,
}

# What moves in the scene although a viewer would not call it an object.
SCENERY = {"none": 62, "water": 10, "leaves": 9, "smoke": 5, "crowd": 4, "screen": 5, "shadow": 5}

GRAPHICS = {"none": 58, "caption": 12, "logo": 8, "bars": 8, "clock": 3, "inset": 4, "hud": 4, "cursor": 3}

CODE = {"none": 35, "x264": 50, "mpeg2": 15}  # of a batch of films

# Each alone, as a probability.
MOTION_BLUR = 0.25
DEFOCUS = 0.2  # of the whole picture
LENS = 0.3  # radial distortion
ROLLING_SHUTTER = 0.25  # where the camera turns
LOW_CONTRAST = 0.3
EXPOSURE = 0.12  # changes while the film runs
FLICKER = 0.05
INTERLACED = 0.05
NOISE = {0.0: 22, 1.0: 35, 3.0: 28, 7.0: 15}  # up to how many grey levels
COARSE_NOISE = 0.4  # as after a codec or an enlargement
MJPEG = 0.12

SPEED_px = (0.15, 22.0)  # of an object, px a frame; logarithmic
AREA = (0.0008, 0.5)  # of the picture that an object has; logarithmic; the smallest is 8 px


def choose(rng, table):
    """A key of `table`, by its weight."""
    keys, weights = list(table), list(table.values())
    at = rng.random() * sum(weights)
    for key, weight in zip(keys, weights):
        at -= weight
        if at < 0:
            return key
    return keys[-1]


def log_uniform(rng, low, high):
    import math

    return math.exp(rng.uniform(math.log(low), math.log(high)))
