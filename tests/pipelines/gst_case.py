# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""For tests of pipelines in real time, in this process, with the plugin as GStreamer loads it. Every tick of each
spidarmotion and spidarsink is recorded and checked."""

import csv
import itertools
import math
import sys

import track_case

try:
    import gi
    gi.require_version("Gst", "1.0")
    from gi.repository import Gst
except (ImportError, ValueError) as missing:
    print(f"skipped: {missing}; Debian has it in python3-gi and gir1.2-gstreamer-1.0")
    sys.exit(77)

Gst.init(None)
ENDS = Gst.MessageType.EOS | Gst.MessageType.ERROR
REST_TICKS = 52  # ramp_s, and what the device needs to answer
ROUNDING = 1 + 1e-12


class Outcome:
    """How a pipeline ended, and what it said."""

    def __init__(self):
        self.eos = False
        self.error = ""
        self.warnings = []
        self.forces = []  # of each analysed frame: x and y, N
        self.of_track = []  # the same, of frames and blocks with a haptic track

    def take(self, message):
        if message.type == Gst.MessageType.EOS:
            self.eos = True
        elif message.type == Gst.MessageType.ERROR:
            self.error = message.parse_error()[0].message
        elif message.type == Gst.MessageType.WARNING:
            self.warnings.append(message.parse_warning()[0].message)
        elif message.type == Gst.MessageType.ELEMENT and message.get_structure().get_name() == "spidar-motion":
            found = message.get_structure()
            force = (found.get_value("force-x"), found.get_value("force-y"))
            (self.of_track if found.get_value("track") else self.forces).append(force)

    @property
    def largest_N(self):
        return max((math.hypot(*force) for force in self.forces), default=0)


def read_ticks(path):
    """The rows of a haptic trace, by the names of its columns."""
    with open(path, newline="", encoding="ascii") as rows:
        return list(csv.DictReader(rows))


def vector(row, name, unit="N"):
    """A vector of a row, e.g. `commanded_force`."""
    return [float(row[f"{name}_{axis}_{unit}"]) for axis in "xyz"]


class GstCase(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.traces = (self.path(f"ticks{n}.csv") for n in itertools.count())

    def parse(self, line):
        """A pipeline whose elements are watched from now on."""
        return self.watch(Gst.parse_launch(line))

    def watch(self, pipeline):
        pipeline.watched = []
        self.addCleanup(pipeline.set_state, Gst.State.NULL)

        def record(element):
            is_ours = type(element).__name__ in ("GstSpidarMotion", "GstSpidarSink")
            if is_ours and element.get_property("device") != "none" and not element.get_property("haptic-trace"):
                pipeline.watched.append(next(self.traces))
                element.set_property("haptic-trace", str(pipeline.watched[-1]))

        pipeline.connect("deep-element-added", lambda _pipeline, _bin, element: record(element))
        elements = pipeline.iterate_recurse()
        while (item := elements.next())[0] == Gst.IteratorResult.OK:
            record(item[1])
        return pipeline

    def play(self, pipeline, frames=None):
        """Plays a pipeline, or a launch line, to its end, or until so many frames were analysed."""
        if isinstance(pipeline, str):
            pipeline = self.parse(pipeline)
        pipeline.set_state(Gst.State.PLAYING)
        outcome = Outcome()
        while not (outcome.eos or outcome.error) and (frames is None or len(outcome.forces) < frames):
            outcome.take(pipeline.bus.timed_pop(Gst.CLOCK_TIME_NONE))
        self.stop(pipeline)
        return outcome

    def stop(self, pipeline):
        pipeline.set_state(Gst.State.NULL)
        for trace in pipeline.watched:
            if trace.exists():  # else it failed to start
                self.check_ticks(read_ticks(trace))

    def check_ticks(self, rows):
        """No limit is exceeded, and there is rest where nothing is to be felt."""
        unfelt = 0
        for row in rows:
            force, torque = vector(row, "commanded_force"), vector(row, "commanded_torque", "Nm")
            self.assertLessEqual(math.hypot(*force), float(row["max_force_N"]) * ROUNDING, row)
            self.assertLessEqual(math.hypot(*torque), float(row["max_torque_Nm"]) * ROUNDING, row)
            is_felt = row["playing"] == "1" and row["found"] in ("exact", "interpolated", "held")
            unfelt = 0 if is_felt or row["contact_depth_m"] != "0" else unfelt + 1
            if unfelt > REST_TICKS and row["device"] == "running":
                self.assertEqual(math.hypot(*force, *torque), 0, row)
