#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Frames of a program, felt as they come."""

import time

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst  # noqa: E402

Gst.init(None)
show = Gst.parse_launch("appsrc name=source is-live=true do-timestamp=true format=time caps=video/x-raw,format=GRAY8,"
                        "width=320,height=240,framerate=25/1 ! spidarmotion ! videoconvert ! autovideosink")
source = show.get_by_name("source")
show.set_state(Gst.State.PLAYING)
source.get_state(Gst.CLOCK_TIME_NONE)  # from then on there is a time
for n in range(25):
    row = bytes((x - 3 * n) // 20 % 2 * 200 for x in range(320))
    source.emit("push-buffer", Gst.Buffer.new_wrapped(row * 240))
    time.sleep(.04)
source.emit("end-of-stream")
show.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR)
show.set_state(Gst.State.NULL)
