#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""As an effect of a GES timeline the element warns that it is in the wrong place; after the timeline it works."""
import csv
import os
import sys
import tempfile

try:
    import gi
    gi.require_version("Gst", "1.0")
    gi.require_version("GES", "1.0")
    from gi.repository import GES, Gst
except (ImportError, ValueError) as missing:
    print(f"skipped: {missing}; Debian has it in python3-gi and gir1.2-ges-1.0")
    sys.exit(77)

PAPER = "motion=mean filter-min-cutoff=0"


def play(effect, sink):
    """Two clips of a second each. What spidarmotion warns of."""
    timeline = GES.Timeline.new()
    timeline.add_track(GES.VideoTrack.new())
    layer = timeline.append_layer()
    for second in range(2):
        clip = GES.TestClip.new()
        clip.props.vpattern = GES.VideoTestPattern.SMPTE
        clip.props.start = second * Gst.SECOND
        clip.props.duration = Gst.SECOND
        layer.add_clip(clip)
        if effect:
            assert clip.add(GES.Effect.new(effect))
    pipeline = GES.Pipeline()
    pipeline.set_timeline(timeline)
    pipeline.props.video_sink = Gst.parse_bin_from_description(sink, True)
    pipeline.set_mode(GES.PipelineFlags.VIDEO_PREVIEW)
    warnings = []
    bus = pipeline.get_bus()
    pipeline.set_state(Gst.State.PLAYING)
    while True:
        message = bus.timed_pop_filtered(
            20 * Gst.SECOND, Gst.MessageType.EOS | Gst.MessageType.ERROR | Gst.MessageType.WARNING)
        assert message, "no end"
        if message.type != Gst.MessageType.WARNING:
            break
        if message.src.get_factory().get_name() == "spidarmotion":
            warnings.append(message.parse_warning()[0].message)
    assert message.type == Gst.MessageType.EOS, message.parse_error()
    pipeline.set_state(Gst.State.NULL)
    return warnings


def main():
    Gst.init(None)
    GES.init()
    warnings = play(f"spidarmotion {PAPER}", "fakesink sync=true")
    assert warnings and "timeline" in warnings[0], warnings
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "haptic.csv")
        warnings = play(None, f"spidarmotion {PAPER} haptic-trace={trace} ! queue ! fakesink sync=true")
        assert not warnings, warnings
        with open(trace) as file:
            reached = {int(row["frame_ns"]) for row in csv.DictReader(file) if row["playing"] == "1"}
    # Of 60 frames; the last is at its end, and the first may be over when the first tick comes.
    assert len(reached) > 40 and max(reached) > 1.9e9, sorted(reached)


if __name__ == "__main__":
    main()
