#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws the strings of a profile with their numbers, as the person who holds the grip sees them.

    docs/figures/strings.py spidar/profiles/shipped/spidar-gcc.toml > docs/figures/strings-spidar-gcc.svg
"""

import math
import sys
import tomllib

UNITS_M = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
WIDTH, HEIGHT = 620, 520


def points(geometry, name):
    """The profile's points in metres, x right, y up, z towards the person."""
    scale = UNITS_M[geometry.get("unit", "m")]
    flip = -1 if geometry.get("frame") == "left-handed" else 1
    return [(x * scale, y * scale, flip * z * scale) for x, y, z in geometry[name]]


def project(point):
    """From the front, a little from the right and above."""
    x, y, z = point
    turn, tilt = math.radians(24), math.radians(16)
    x, z = x * math.cos(turn) - z * math.sin(turn), x * math.sin(turn) + z * math.cos(turn)
    y, z = y * math.cos(tilt) - z * math.sin(tilt), y * math.sin(tilt) + z * math.cos(tilt)
    return x, y, z


def main(path):
    with open(path, "rb") as file:
        profile = tomllib.load(file)
    exits, grip = points(profile["geometry"], "exit"), points(profile["geometry"], "grip")
    reach = max(math.hypot(*project(p)[:2]) for p in exits)
    scale = 0.40 * HEIGHT / reach

    def place(point):
        x, y, _ = project(point)
        return WIDTH / 2 + scale * x, HEIGHT / 2 + 10 - scale * y

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="DejaVu Sans, Helvetica, Arial, sans-serif">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
        f'<text x="14" y="24" font-size="14" font-weight="bold">{profile["description"]}</text>',
    ]
    # The box around the exits, in thin lines.
    low = [min(p[i] for p in exits) for i in range(3)]
    high = [max(p[i] for p in exits) for i in range(3)]
    corner = lambda bits: tuple(high[i] if bits >> i & 1 else low[i] for i in range(3))
    for a in range(8):
        for axis in range(3):
            if not a >> axis & 1:
                (x1, y1), (x2, y2) = place(corner(a)), place(corner(a | 1 << axis))
                out.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="#ccc"/>')
    middle = (low[2] + high[2]) / 2
    for string, (exit_m, grip_m) in sorted(
        enumerate(zip(exits, grip)), key=lambda item: project(item[1][0])[2]
    ):
        (x1, y1), (x2, y2) = place(exit_m), place(grip_m)
        near = exit_m[2] >= middle
        colour = "#b03a2e" if near else "#2e6da4"
        out.append(
            f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
            f'stroke-width="{2.4 if near else 1.4}"/>'
            f'<circle cx="{x2:.1f}" cy="{y2:.1f}" r="3" fill="#333"/>'
            f'<circle cx="{x1:.1f}" cy="{y1:.1f}" r="12" fill="#fff" stroke="{colour}" stroke-width="2"/>'
            f'<text x="{x1:.1f}" y="{y1 + 5:.1f}" font-size="13" text-anchor="middle">{string}</text>'
        )
    out.append(
        f'<text x="14" y="{HEIGHT - 14}" font-size="12" fill="#444">seen by the person who holds the grip; '
        'red: exits near the person, blue: exits far away</text></svg>'
    )
    print("\n".join(out))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} PROFILE.toml > PICTURE.svg")
    main(sys.argv[1])
