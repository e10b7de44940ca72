#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A film in GStreamer Editing Services, felt: editing.py FILM."""

import signal
import sys

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GES", "1.0")
from gi.repository import Gst, GES  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
GES.init()
timeline, show = GES.Timeline.new_audio_video(), GES.Pipeline()
timeline.append_layer().add_clip(GES.UriClip.new(Gst.filename_to_uri(sys.argv[1])))
show.set_timeline(timeline)
show.preview_set_video_sink(Gst.parse_bin_from_description("spidarmotion ! videoconvert ! autovideosink", True))
show.preview_set_audio_sink(Gst.parse_launch("fakesink sync=true"))
show.set_state(Gst.State.PLAYING)
show.get_bus().timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR)
show.set_state(Gst.State.NULL)
