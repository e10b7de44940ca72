#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Frames of a program, felt as they come: stripes that move to the left, for a second."""

import signal
import time

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
show = Gst.parse_launch("appsrc name=source is-live=true do-timestamp=true format=time caps=video/x-raw,format=GRAY8,"
                        "width=320,height=240,framerate=25/1 ! spidarmotion name=motion ! videoconvert ! autovideosink")
source = show.get_by_name("source")
show.set_state(Gst.State.PLAYING)
source.get_state(Gst.CLOCK_TIME_NONE)  # from then on there is a time
for n in range(25):
    row = bytes((x - 3 * n) // 20 % 2 * 200 for x in range(320))
    source.emit("push-buffer", Gst.Buffer.new_wrapped(row * 240))
    time.sleep(.04)
source.emit("end-of-stream")
end = show.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR)
frames = show.get_by_name("motion").get_property("stats").get_value("frames")
print(end.parse_error()[0].message if end.type == Gst.MessageType.ERROR else
      f"25 pictures of stripes that move to the left were pushed in a second, and {frames} of them were felt")
show.set_state(Gst.State.NULL)
