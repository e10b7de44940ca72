#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The force of each frame of a film, why there is none, and when the device is opened, lost or back: forces.py FILM."""

import signal
import sys

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
player = Gst.parse_launch("playbin audio-sink=fakesink video-sink=autovideosink video-filter=spidarmotion")
player.set_property("uri", Gst.filename_to_uri(sys.argv[1]))
player.set_state(Gst.State.PLAYING)
while (message := player.bus.timed_pop(Gst.CLOCK_TIME_NONE)).type != Gst.MessageType.EOS:
    fields = message.get_structure()
    if message.type == Gst.MessageType.ERROR:
        sys.exit(message.parse_error()[0].message)
    if message.has_name("spidar-motion"):
        print(fields.get_value("running-time") / Gst.SECOND, "s:", fields.get_value("force-x"), fields.get_value("force-y"), "N",
              fields.get_value("no-force-text"), fields.get_value("device-no-force-text"))
    elif message.has_name("spidar-device"):
        print(fields.get_value("device"), fields.get_value("state"), fields.get_value("reason"))
player.set_state(Gst.State.NULL)
