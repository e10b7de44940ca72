#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws a SPIDAR-G with a hand: its frame, motors, strings and grip are those of the profile `spidar-g`.

    docs/figures/spidar.py > docs/figures/spidar.svg
"""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/figures"))
from strings import points, project  # noqa: E402

WIDTH, HEIGHT, SCALE = 760, 520, 1850  # the last in pixels a metre
CENTRE = 340, 255
SKIN, OUTLINE = "#e3b391", "#7a5238"


def place(point):
    x, y, _ = project(point)
    return CENTRE[0] + SCALE * x, CENTRE[1] - SCALE * y


def line(a, b, colour, width):
    (x1, y1), (x2, y2) = a, b
    return (f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
            f'stroke-width="{width}" stroke-linecap="round"/>')


def limb(width, *corners):
    """A finger or an arm: a thick line with round ends and an outline."""
    path = "M" + " L".join(f"{x:.0f},{y:.0f}" for x, y in corners)
    style = 'fill="none" stroke-linecap="round" stroke-linejoin="round"'
    return (f'<path d="{path}" {style} stroke="{OUTLINE}" stroke-width="{width + 3}"/>'
            f'<path d="{path}" {style} stroke="{SKIN}" stroke-width="{width}"/>')


def note(text, at, target):
    x, y = at
    words = "".join(f'<tspan x="{x}" dy="{0 if n == 0 else 19}">{row}</tspan>' for n, row in enumerate(text.split("|")))
    (x2, y2) = target
    return line((x - 6, y - 5), (x2, y2), "#8a8f96", 1) + f'<text x="{x}" y="{y}" font-size="16" fill="#222">{words}</text>'


def main():
    with open(ROOT / "spidar/profiles/shipped/spidar-g.toml", "rb") as file:
        geometry = tomllib.load(file)["geometry"]
    exits, grip = points(geometry, "exit"), points(geometry, "grip")
    low, high = ([f(p[i] for p in exits) for i in range(3)] for f in (min, max))
    corner = lambda bits: tuple(high[i] if bits >> i & 1 else low[i] for i in range(3))
    edges = [(corner(a), corner(a | 1 << i)) for a in range(8) for i in range(3) if not a >> i & 1]
    middle = (low[2] + high[2]) / 2
    depth = lambda p: project(p)[2]

    behind = sorted(edges, key=lambda e: depth(e[0]) + depth(e[1]))
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="DejaVu Sans, Helvetica, Arial, sans-serif">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
    ]

    def frame(part):
        for a, b in part:
            shade = "#9aa3ad" if depth(a) + depth(b) > 0 else "#c9ced4"
            out.append(line(place(a), place(b), shade, 7))

    def motor(point):
        x, y = place(point)
        out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="13" fill="#3b4149"/>'
                   f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="#d9dde2"/>')

    def strings(near):
        for exit_m, grip_m in zip(exits, grip):
            if (exit_m[2] >= middle) == near:
                motor(exit_m)
                out.append(line(place(exit_m), place(grip_m), "#0072b2", 2))

    frame(behind[:6])
    strings(False)
    frame(behind[6:])
    x, y = place((0, 0, 0))
    out.append(limb(62, (x + 54, y + 290), (x + 68, y + 112), (x + 58, y + 46)))  # arm and palm
    ball = 0.86 * max(abs(c) for p in grip for c in p) * SCALE
    out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{ball:.1f}" fill="#f0b429" stroke="#8a6410" stroke-width="2"/>')
    strings(True)
    for p in grip:
        gx, gy = place(p)
        out.append(f'<circle cx="{gx:.1f}" cy="{gy:.1f}" r="4" fill="#222"/>')
    for n in range(4):  # fingers around the ball
        out.append(limb(17, (x + 70 - 3 * n, y + 8 + 18 * n), (x + 34 - 8 * n, y - 22 + 17 * n), (x + 4 - 4 * n, y - 8 + 15 * n)))
    out.append(limb(20, (x + 62, y + 88), (x + 14, y + 72), (x - 20, y + 46)))  # thumb
    near = place(exits[6])
    out += [
        note("motor with pulley and|encoder, for one string", (570, 150), (near[0] + 14, near[1])),
        note("string: it can only pull", (570, 60), (392, 165)),
        note("grip: eight strings|move it in every|direction, and turn it", (570, 250), (x + 16, y - 34)),
    ]
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
