#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Draws docs/figures/architecture.svg: threads, the queues between them, and a frame's way to a motor.

    docs/figures/architecture.py > docs/figures/architecture.svg
"""

from html import escape

WIDTH, HEIGHT = 1180, 800
COLOURS = {"plugin": "#dbe9f8", "core": "#e2f3df", "spidar": "#fdebd0", "outside": "#ececec", "queue": "#ffffff"}
parts = []


def text(x, y, words, size=13, anchor="middle", weight="normal", colour="#1a1a1a"):
    parts.append(
        f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}" font-weight="{weight}" '
        f'fill="{colour}">{escape(words)}</text>'
    )


def box(x, y, width, height, layer, title, *lines):
    """A part of one layer; returns its middle points: left, right, top, bottom."""
    dash = ' stroke-dasharray="5 3"' if layer == "queue" else ""
    parts.append(
        f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="6" fill="{COLOURS[layer]}" '
        f'stroke="#555"{dash}/>'
    )
    top = y + height / 2 - 8 * len(lines) + 5
    text(x + width / 2, top, title, 13, weight="bold")
    for i, line in enumerate(lines):
        text(x + width / 2, top + 16 * (i + 1), line, 12)
    middle_x, middle_y = x + width / 2, y + height / 2
    return {"l": (x, middle_y), "r": (x + width, middle_y), "t": (middle_x, y), "b": (middle_x, y + height)}


def lane(y, height, title, rule, x=24):
    parts.append(
        f'<rect x="10" y="{y}" width="{WIDTH - 20}" height="{height}" rx="10" fill="#fafafa" stroke="#bbb"/>'
    )
    text(x, y + 20, title, 14, "start", "bold", "#333")
    text(x, y + 37, rule, 12, "start", colour="#555")


def arrow(*points):
    path = "M" + " L".join(f"{x},{y}" for x, y in points)
    parts.append(f'<path d="{path}" fill="none" stroke="#333" stroke-width="1.6" marker-end="url(#head)"/>')


def note(x, y, words):
    text(x, y, words, 11, colour="#444")


# The streaming thread.
lane(40, 190, "Streaming thread (GStreamer's)", "May lock for a moment. Allocates nothing after the first frames.")
frame = box(30, 110, 110, 70, "outside", "decoder", "video frames")
luma = box(180, 100, 150, 90, "plugin", "spidarmotion", "maps the frame,", "gives it on unchanged")
field = box(370, 100, 150, 90, "core", "field", "where each block", "went since before")
motion = box(560, 100, 150, 90, "core", "motion", "camera, objects,", "which one is felt")
force = box(750, 100, 150, 90, "core", "force", "filter, controller:", "velocity to wrench")
schedule = box(940, 100, 210, 90, "plugin", "WrenchBacklog", "keeps what the loop", "has no room for yet")
for a, b in ((frame, luma), (luma, field), (field, motion), (motion, force), (force, schedule)):
    arrow(a["r"], b["l"])
text(735, 213, "what was found goes to the bus, the trace, the meta, the overlay and the window", 12, colour="#555")

# The follower.
lane(250, 130, "spidar-clock, 100 times a second", "Reads the pipeline's clock, base time and latency. May lock.")
follower = box(180, 305, 190, 58, "plugin", "PlaybackFollower", "when is a frame on the screen?")
clock = box(470, 305, 170, 58, "queue", "PlaybackClock", "seqlock, newest value")
ring = box(940, 305, 210, 58, "queue", "timed wrenches", "ring of 256, one writer")
arrow(follower["r"], clock["l"])
arrow(schedule["b"], ring["t"])

# The loop.
lane(400, 180, "spidar-haptic, 1000 times a second, real-time priority", "No lock, no allocation, no file, no log, no exception.")
tick = box(940, 465, 210, 80, "core", "WrenchTimeline", "wrench for this millisecond,", "interpolated between frames")
limits = box(745, 465, 160, 80, "spidar", "HapticLoop::limit()", "total limits,", "vibration, brake,", "rates, ramp to rest")
solver = box(550, 465, 160, 80, "core", "TensionSolver", "wrench and pose to", "string tensions")
motors = box(355, 465, 160, 80, "spidar", "TensionSlew, heat", "tensions to volts")
pose = box(160, 465, 160, 80, "core", "PoseSolver", "string lengths", "to pose")
arrow(ring["b"], tick["t"])
arrow(clock["b"], (555, 440), (1000, 440), (1000, 465))
for a, b in ((tick, limits), (limits, solver), (solver, motors)):
    arrow(a["l"], b["r"])
arrow(pose["t"], (240, 452), (630, 452), solver["t"])
note(430, 448, "pose of the tick before")

# The link.
lane(600, 130, "spidar-link, one thread for a board; none for the simulated device", "libusb and the kernel may lock and allocate: the loop waits 0.7 ms at most.", 560)
exchange = box(355, 655, 180, 58, "spidar", "LinkThread", "volts out, counts in")
board = box(620, 655, 200, 58, "outside", "board", "eight motors, eight encoders")
guard = box(900, 655, 250, 58, "outside", "spidar-guardian, a process", "zeroes the motors if this one dies")
arrow(motors["b"], (435, 655))
arrow((390, 655), (390, 620), (240, 620), pose["b"])
note(475, 592, "two requests")
note(315, 615, "four replies")
arrow(exchange["r"], board["l"])
arrow(guard["l"], board["r"])

# Legend.
x = 30
for layer, words in (
    ("plugin", "plugin/: GStreamer"),
    ("spidar", "spidar/: the device"),
    ("core", "core/: computing only"),
    ("queue", "wait-free queue or value"),
    ("outside", "outside"),
):
    dash = ' stroke-dasharray="5 3"' if layer == "queue" else ""
    parts.append(f'<rect x="{x}" y="755" width="22" height="16" fill="{COLOURS[layer]}" stroke="#555"{dash}/>')
    text(x + 30, 768, words, 12, "start")
    x += 205
text(WIDTH / 2, 26, "From a frame of video to the eight motors", 17, weight="bold")

print(
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
    'font-family="DejaVu Sans, Helvetica, Arial, sans-serif">'
    '<defs><marker id="head" markerWidth="9" markerHeight="9" refX="7" refY="4" orient="auto">'
    '<path d="M0,0 L8,4 L0,8 z" fill="#333"/></marker></defs>'
    f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>'
)
print("\n".join(parts))
print("</svg>")
