# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Reads the meta in Python, after elements that change the picture, and runs examples/read_meta.py:
check_meta.py EXAMPLE"""
import re
import subprocess
import sys

try:
    import gi
    gi.require_version("Gst", "1.0")
    from gi.repository import Gst
except (ImportError, ValueError) as missing:
    print(f"skipped: {missing}; Debian has it in python3-gi and gir1.2-gstreamer-1.0")
    sys.exit(77)


def check_example():
    lines = subprocess.run([sys.executable, sys.argv[1]], check=True, stdout=subprocess.PIPE,
                           text=True).stdout.splitlines()
    row = re.compile(
        r" *([0-9.]+) s  velocity +(\S+) +(\S+) px/s  force +(\S+) +(\S+) N  ([0-9]+) points")
    thing = re.compile(r"    object 1 at (\d+),(\d+), (\d+) x (\d+) px: \S+ \S+ px/s, felt")
    boxes = [[int(value) for value in thing.fullmatch(line).groups()]
             for line in lines if line.startswith("    object")]
    assert len(boxes) > 20, f"the ball is an object in {len(boxes)} frames"
    for x, y, w, h in boxes:  # the ball's radius is 20 px, the picture's size 320 x 240
        assert 40 <= w < 110 and 40 <= h < 110 and x + w <= 320 and y + h <= 240, (x, y, w, h)
    rows = [[float(value) for value in row.fullmatch(line).groups()]
            for line in lines if not line.startswith("    object")]
    assert len(rows) == 30, f"{len(rows)} frames, not 30"
    # The ball flies: after the first frame there are points. It is an object from the second pair of
    # frames on, and the force goes the way of the motion, whose y axis points down, apart from the
    # few frames that the filter is late by when it turns.
    for seconds, _, _, _, _, points in rows[1:]:
        assert points > 0, f"no points at {seconds} s"
    along = [velocity_x * force_x - velocity_y * force_y > 0
             for _, velocity_x, velocity_y, force_x, force_y, _ in rows[5:]]
    assert sum(along) > len(along) / 2, f"force along the motion in {sum(along)} of {len(along)}"


def metas_after(elements):
    """What is read of each frame behind `elements`: None without the meta."""
    pipeline = Gst.parse_launch(
        "videotestsrc pattern=ball num-buffers=5 ! video/x-raw,format=I420,width=320,height=240 "
        f"! spidarmotion device=none attach-meta=true ! {elements} ! fakesink name=sink")
    found = []

    def read(_pad, info):
        meta = info.get_buffer().get_custom_meta("GstSpidarMotionMeta")
        frame = meta and meta.get_structure()
        found.append(frame and (frame.get_value("width"), frame.get_value("height"),
                                frame.get_value("velocity-x"), frame.get_value("force-x"),
                                frame.get_value("points").unpack()))
        return Gst.PadProbeReturn.OK

    pipeline.get_by_name("sink").get_static_pad("sink").add_probe(Gst.PadProbeType.BUFFER, read)
    pipeline.set_state(Gst.State.PLAYING)
    message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE,
                                              Gst.MessageType.EOS | Gst.MessageType.ERROR)
    pipeline.set_state(Gst.State.NULL)
    assert message.type == Gst.MessageType.EOS, message.parse_error()
    return found


Gst.init(None)
check_example()
plain = metas_after("identity")
assert len(plain) == 5 and all(plain) and plain[-1][4]
assert metas_after("queue ! videoconvert ! video/x-raw,format=BGRx") == plain
scaled = metas_after("videoconvert ! videoscale ! video/x-raw,width=640,height=120")
for (_, _, velocity, force, points), after in zip(plain, scaled, strict=True):
    assert after[:4] == (640, 120, 2 * velocity, force), after[:4]
    for (number, x, _, _, y, _), (same, scaled_x, _, _, scaled_y, _) in zip(points, after[4],
                                                                           strict=True):
        assert number == same
        # In units of pixels whose first centre is (0, 0): (x + 1/2) 2 - 1/2.
        assert abs(scaled_x - (2 * x + 0.5)) < 1e-9 and abs(scaled_y - (y / 2 - 0.25)) < 1e-9
cropped = metas_after("videocrop left=10")
if Gst.version()[:2] < (1, 28):
    assert cropped == [None] * 5, "coordinates of another picture"
else:
    for (_, _, velocity, force, points), after in zip(plain, cropped, strict=True):
        assert after[:4] == (310, 240, velocity, force), after[:4]
        assert all(abs(x - 10 - moved) < 1e-9
                   for (_, x, *_), (_, moved, *_) in zip(points, after[4], strict=True))
    for (_, _, velocity, force, _), after in zip(plain, metas_after("videoflip method=horizontal-flip"), strict=True):
        assert abs(after[2] + velocity) < 1e-9 and abs(after[3] + force) < 1e-9, after[:4]
