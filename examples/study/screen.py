# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""When the sink of a clip showed each frame, which the element before its queue cannot know."""

import csv
import time

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst  # noqa: E402

COLUMNS = ["running_ns", "shown_ns"]  # shown_ns: of CLOCK_MONOTONIC; empty if the sink dropped the frame


def sink_in(element):
    """The one that shows frames, in the bins that choose it."""
    while isinstance(element, Gst.Bin):
        element = element.iterate_sinks().next()[1]
    return element


class Screen:
    """Looks at what goes into the sink behind `pad`, and what comes out of it: a frame is shown when the sink is done with it,
    by this program's clock, whenever it was due. Only frames that the sink has rendered were shown."""

    def __init__(self, pad):
        self.pad, self.segment, self.running_ns, self.rows = pad, None, None, []
        kinds = Gst.PadProbeType.BUFFER | Gst.PadProbeType.EVENT_DOWNSTREAM | Gst.PadProbeType.EVENT_UPSTREAM
        pad.add_probe(kinds, self.look)

    def look(self, _, info):
        """In the streaming thread, after the sink is done with a frame: it says how late that was (QOS), where it says so, or
        takes what is next."""
        event = info.get_event() if not info.type & Gst.PadProbeType.BUFFER else None
        if event and info.type & Gst.PadProbeType.EVENT_UPSTREAM and event.type != Gst.EventType.QOS:
            return Gst.PadProbeReturn.OK  # of another thread
        if self.running_ns is not None:
            done_ns, rendered = time.monotonic_ns(), self.rendered()
            self.rows.append([self.running_ns, done_ns if rendered > self.before else ""])
            self.running_ns = None
        if event is None:
            self.running_ns, self.before = self.segment.to_running_time(Gst.Format.TIME, info.get_buffer().pts), self.rendered()
        elif event.type == Gst.EventType.SEGMENT:
            self.segment = event.parse_segment()
        return Gst.PadProbeReturn.OK

    def sink(self):
        return sink_in(self.pad.get_peer().get_parent_element())

    def rendered(self):
        return self.sink().get_property("stats").get_uint64("rendered")[1]

    def write(self, path):
        with open(path, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *self.rows])
