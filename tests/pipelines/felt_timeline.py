#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""felt_timeline.py FILM: plays a GES timeline of a film for a second. Without GES, the exit status is 77."""
import sys

try:
    import gi
    gi.require_version("Gst", "1.0")
    gi.require_version("GES", "1.0")
    from gi.repository import GES, Gst
except (ImportError, ValueError) as missing:
    print(f"{missing}; Debian has it in python3-gi and gir1.2-ges-1.0")
    sys.exit(77)

Gst.init(None)
GES.init()
timeline = GES.Timeline.new()
timeline.add_track(GES.VideoTrack.new())
clip = GES.UriClip.new(Gst.filename_to_uri(sys.argv[1]))
clip.props.duration = Gst.SECOND
assert timeline.append_layer().add_clip(clip)
pipeline = GES.Pipeline()
pipeline.set_timeline(timeline)
pipeline.props.video_sink = Gst.ElementFactory.make("fakevideosink")
pipeline.set_mode(GES.PipelineFlags.VIDEO_PREVIEW)
pipeline.set_state(Gst.State.PLAYING)
message = pipeline.get_bus().timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR)
assert message.type == Gst.MessageType.EOS, message.parse_error()
pipeline.set_state(Gst.State.NULL)
