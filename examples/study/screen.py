# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""When the sink of a clip showed each frame, which the element before its queue cannot know."""

import csv
import time

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstBase", "1.0")  # get_latency() of a sink is known by it
from gi.repository import Gst, GstBase  # noqa: E402, F401

COLUMNS = ["running_ns", "shown_ns"]  # shown_ns: of CLOCK_MONOTONIC; empty if the sink dropped the frame


def sink_in(element):
    """The one that shows frames, in the bins that choose it."""
    while isinstance(element, Gst.Bin):
        element = element.iterate_sinks().next()[1]
    return element


class Screen:
    """Looks at what goes into the sink behind `pad`. A frame is shown when it is due, or when it arrives if that is later:
    a sink that stands still takes the next one late. Only frames that it has rendered were shown."""

    def __init__(self, pipeline, pad):
        self.pipeline, self.pad, self.segment, self.rows = pipeline, pad, None, []
        self.zero_ns = 2**62  # of the pipeline's clock, in CLOCK_MONOTONIC
        pad.add_probe(Gst.PadProbeType.BUFFER | Gst.PadProbeType.EVENT_DOWNSTREAM, self.look)

    def look(self, _, info):
        """In the streaming thread, after the sink is done with the frame before."""
        event = info.get_event() if info.type & Gst.PadProbeType.EVENT_DOWNSTREAM else None
        if event:
            if event.type == Gst.EventType.SEGMENT:
                self.segment = event.parse_segment()
            return Gst.PadProbeReturn.OK
        arrived_ns = time.monotonic_ns()
        self.rows.append((self.segment.to_running_time(Gst.Format.TIME, info.get_buffer().pts), self.rendered(), arrived_ns))
        self.compare_clocks()
        return Gst.PadProbeReturn.OK

    def compare_clocks(self):
        """Of many comparisons, the one with the least time between the two is the nearest."""
        if clock := self.pipeline.get_clock():
            clock_ns = clock.get_time()
            self.zero_ns = min(self.zero_ns, time.monotonic_ns() - clock_ns)

    def sink(self):
        return sink_in(self.pad.get_peer().get_parent_element())

    def rendered(self):
        return self.sink().get_property("stats").get_uint64("rendered")[1]

    def write(self, path):
        """When the clip has ended, and still plays."""
        self.compare_clocks()
        due_ns, done = self.zero_ns + self.pipeline.get_base_time(), [rendered for _, rendered, _ in self.rows[1:]]
        if self.rows:
            due_ns += self.sink().get_latency() + self.sink().get_property("ts-offset")
            done.append(self.rendered())
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            for (running_ns, before, arrived_ns), after in zip(self.rows, done):
                writer.writerow([running_ns, max(arrived_ns, due_ns + running_ns) if after > before else ""])
