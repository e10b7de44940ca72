#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints what spidarmotion attaches to each frame of FILE, or of the ball of videotestsrc.

Needs python3-gi, gir1.2-gstreamer-1.0 and gir1.2-gst-plugins-base-1.0, and GST_PLUGIN_PATH as in docs/start.md.
"""
import argparse
import signal
import sys

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstVideo", "1.0")
from gi.repository import GLib, Gst, GstVideo  # noqa: E402


def objects(buffer, points):
    """The regions of the frame's objects, whose ids are those of the points."""
    for number in sorted({point[5] for point in points} - {0}):
        region = GstVideo.buffer_get_video_region_of_interest_meta_id(buffer, number)
        if region is not None and GLib.quark_to_string(region.roi_type) == "spidar-object":
            yield region


def read(_pad, info):
    buffer = info.get_buffer()
    meta = buffer.get_custom_meta("GstSpidarMotionMeta")
    if meta is not None:
        get = meta.get_structure().get_value
        points = get("points").unpack()  # [(id, from x, from y, to x, to y, object), ...]
        print(f"{get('running-time') / Gst.SECOND:7.3f} s  "
              f"velocity {get('velocity-x'):7.1f} {get('velocity-y'):7.1f} px/s  "
              f"force {get('force-x'):6.2f} {get('force-y'):6.2f} N  {len(points)} points")
        for region in objects(buffer, points):
            motion = region.get_param("spidar-motion").get_value
            print(f"    object {region.id} at {region.x},{region.y}, {region.w} x {region.h} px: "
                  f"{motion('velocity-x'):.1f} {motion('velocity-y'):.1f} px/s"
                  + (", felt" if motion("felt") else ""))
    return Gst.PadProbeReturn.OK


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("FILE", nargs="?")
file = parser.parse_args().FILE
signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
source = "filesrc name=file ! decodebin" if file else "videotestsrc pattern=ball num-buffers=30"
pipeline = Gst.parse_launch(f"{source} ! videoconvert ! spidarmotion device=none attach-meta=true "
                            "! videoconvert ! fakesink name=sink")
if file:
    pipeline.get_by_name("file").set_property("location", file)
pipeline.get_by_name("sink").get_static_pad("sink").add_probe(Gst.PadProbeType.BUFFER, read)
pipeline.set_state(Gst.State.PLAYING)
message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE,
                                          Gst.MessageType.EOS | Gst.MessageType.ERROR)
pipeline.set_state(Gst.State.NULL)
sys.exit(f"{file}: {message.parse_error().gerror.message}" if message.type == Gst.MessageType.ERROR else 0)
