# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Settings of spidarmotion, its states, errors, traces and stats."""

import csv
import errno
import math
import os
import time
import unittest

import gst_case
from gst_case import Gst

import gi

gi.require_version("GstController", "1.0")
from gi.repository import GObject, GstController  # noqa: E402

MOST_UNREAD = 1000  # UnreadMessages::kMax
FRAME_NS = 40_000_000


def make(properties=""):
    return Gst.parse_launch("spidarmotion " + properties)


class ElementCase(gst_case.GstCase):
    def open(self, properties, width=320, height=240):
        """An element that push() gives frames to, while it plays."""
        self.size = width, height
        pipeline = Gst.parse_launch(
            f"appsrc name=source format=time caps=video/x-raw,format=GRAY8,width={width},height={height},framerate=25/1 ! "
            f"spidarmotion name=motion {properties} ! fakesink async=false sync=false")
        self.addCleanup(pipeline.set_state, Gst.State.NULL)
        self.source, self.element = map(pipeline.get_by_name, ("source", "motion"))
        self.bus, self.pushed, self.passed = pipeline.get_bus(), 0, 0
        self.element.get_static_pad("src").add_probe(Gst.PadProbeType.BUFFER, self.count)
        self.assertNotEqual(pipeline.set_state(Gst.State.PLAYING), Gst.StateChangeReturn.FAILURE)

    def count(self, _pad, _info):
        self.passed += 1
        return Gst.PadProbeReturn.OK

    def stats(self, *names):
        stats = self.element.get_property("stats")
        return [stats.get_value(name) for name in names]

    def push(self, count, px_a_frame=2):
        """The next frames of a texture that moves to the right; returns when they have passed the element."""
        width, height = self.size
        for _ in range(count):
            left = -px_a_frame * self.pushed
            row = [[round(127 + 50 * math.sin(.15 * (x + left) + 1.3 * math.sin(.1 * y)) + 50 * math.sin(.11 * y + .05 * (x + left)))
                    for x in range(width)] for y in range(height)]
            frame = Gst.Buffer.new_wrapped(b"".join(map(bytes, row)))
            frame.pts, frame.duration = self.pushed * FRAME_NS, FRAME_NS
            self.source.emit("push-buffer", frame)
            self.pushed += 1
        while self.passed < self.pushed:  # each after its messages
            time.sleep(.001)

    def messages(self):
        """Those about frames, that wait to be read."""
        found = []
        while message := self.bus.pop_filtered(Gst.MessageType.ELEMENT):
            found.append(message.get_structure())
        return found

    def warnings(self):
        found = []
        while message := self.bus.pop_filtered(Gst.MessageType.WARNING | Gst.MessageType.ERROR):
            self.assertEqual(message.type, Gst.MessageType.WARNING)
            found.append(message.parse_warning()[0].message)
        return found


class Properties(ElementCase):
    def error_at_ready(self, properties):
        element = make(f"on-device-error=error {properties}")
        element.set_bus(Gst.Bus.new())
        try:
            if element.set_state(Gst.State.READY) != Gst.StateChangeReturn.FAILURE:
                return ""
            return element.get_bus().pop_filtered(Gst.MessageType.ERROR).parse_error()[0].message
        finally:
            element.set_state(Gst.State.NULL)

    def test_a_simulated_device_has_a_profile_of_its_own(self):
        boards = self.error_at_ready("device=sim:telepathy").partition("; known are: ")[2].split(", ")
        self.assertIn("sim:sh4", boards)
        for device in ("sim", *boards):
            self.assertEqual(self.error_at_ready(f"device={device}"), "", device)
        # What is asked for is not replaced.
        self.assertIn("negative volts", self.error_at_ready("device=sim:sh4 profile=spidar-gcc"))

    def test_alpha_is_that_of_the_paper_with_its_motion_until_it_is_set(self):
        for properties, expected in (("motion=mean", .01), ("motion=mean motion=camera", .0025), ("motion=objects", .0025),
                                     ("motion=mean alpha=0.0025", .0025), ("alpha=0.02 motion=mean", .02)):
            self.assertEqual(make(properties).get_property("alpha"), expected, properties)

    @staticmethod
    def values(element, names):
        read = (element.get_property(name) for name in names)
        return [getattr(value, "value_nick", value) for value in read]

    @staticmethod
    def own_settings():
        """Without those of its base classes."""
        element = make()
        return [spec for spec in element.list_properties() if spec.owner_type == element.__gtype__]

    @staticmethod
    def another_value(spec):
        if spec.name == "pointer":
            return "0.25,1"
        if spec.name == "area":
            return "8,16,320,240"
        if spec.value_type == GObject.TYPE_STRING:
            return "/a"
        if spec.value_type == GObject.TYPE_BOOLEAN:
            return not spec.default_value
        if GObject.type_is_a(spec.value_type, GObject.TYPE_ENUM):
            return max(type(make().get_property(spec.name)).__enum_values__)
        return spec.maximum

    def test_every_setting_reads_back_what_was_written(self):
        element = make()
        settings = [spec for spec in self.own_settings() if spec.flags & GObject.ParamFlags.WRITABLE]
        wanted = {spec.name: self.another_value(spec) for spec in settings}
        for name, value in wanted.items():
            self.assertNotEqual(element.get_property(name), value, name)
            element.set_property(name, value)
        self.assertEqual({name: element.get_property(name) for name in wanted}, wanted)

    def test_what_was_read_already_stays_with_a_warning(self):
        late = {"device": "ff", "profile": "spidar-g6c", "haptic-trace": "/b", "trace": "/a.csv", "track": "auto"}
        self.open("device=none")
        self.push(2)
        before = self.values(self.element, late)
        for name, value in late.items():
            self.element.set_property(name, value)
            warning = self.warnings()
            self.assertEqual(len(warning), 1, name)
            self.assertTrue(warning[0].startswith(name + " is set too late, and stays as it was: it can be changed in NULL"))
        self.assertEqual(self.values(self.element, late), before)
        # The same value changes nothing.
        self.element.set_property("device", "none")
        self.element.set_property("max-force", 1)
        self.assertEqual(self.warnings(), [])
        # In READY, what is not read yet can be set.
        self.element.get_parent().set_state(Gst.State.READY)
        for name, value in late.items():
            self.element.set_property(name, value)
        self.assertEqual(self.values(self.element, late), before[:3] + ["/a.csv", "auto"])
        self.assertEqual(len(self.warnings()), 3)
        self.element.get_parent().set_state(Gst.State.NULL)
        for name, value in late.items():
            self.element.set_property(name, value)
        self.assertEqual(self.values(self.element, late), list(late.values()))

    def test_each_is_explained_in_a_line(self):
        for spec in self.own_settings():
            self.assertLessEqual(len(spec.blurb.split()), 25, spec.name)
            self.assertNotIn("GstSpidarMotion", spec.value_type.name, "repeats the element")

    def test_messages_that_nobody_reads_end(self):
        self.open("device=none", 32, 32)
        self.push(MOST_UNREAD + 100)
        self.assertEqual(len(self.messages()), MOST_UNREAD)
        # Now they are read.
        self.push(1)
        self.assertEqual(len(self.messages()), 1)

    def test_force_follows_a_controller_while_playing(self):
        self.open("device=none controller=nonlinear alpha=0.01 motion=mean filter-min-cutoff=0")
        source = GstController.InterpolationControlSource.new()
        source.set_property("mode", GstController.InterpolationMode.NONE)
        # Control values are shares of the property's range, 0 … 20 N.
        source.set(0, 2 / 20)
        source.set(2 * FRAME_NS, 4 / 20)
        self.element.add_control_binding(GstController.DirectControlBinding.new(self.element, "max-force", source))
        self.push(3)
        found = self.messages()
        for message, most_N in zip(found[1:], (2, 4)):
            # As it counts for the force: in a frame of 480 lines.
            speed = 480 / 240 * math.hypot(message.get_value("velocity-x"), message.get_value("velocity-y"))
            self.assertGreater(speed, 10)
            force_N = math.hypot(message.get_value("force-x"), message.get_value("force-y"))
            self.assertAlmostEqual(force_N, 2 * most_N / math.pi * math.atan(.01 * speed), delta=1e-12)

    def test_touching_without_a_device_is_a_warning_once(self):
        for properties, said in (("device=none touch=luma", "no device"), ("device=none touch=off", None),
                                 ("device=sim touch=luma touch-stiffness=800", None), ("device=sim touch=depth", None)):
            self.open(properties)
            self.push(3)
            warnings = self.warnings()
            self.assertEqual(len(warnings), said is not None, warnings)
            self.assertTrue(said is None or said in warnings[0], warnings)


class States(unittest.TestCase):
    def test_each_is_reached_from_each_other(self):
        """All sequences of state changes, as in GStreamer's generic tests of elements."""
        null, ready, paused, playing = Gst.State.NULL, Gst.State.READY, Gst.State.PAUSED, Gst.State.PLAYING
        for properties in ("device=none", "device=sim", "device=sim:sh4 profile=spidar-g6x3-v2-r"):
            for way in ((ready, paused, playing, paused, ready, null, ready, paused, playing),
                        (playing, paused, playing, ready, playing, null, playing),
                        (ready, null, ready, paused, ready, null, paused, null), (playing, null, playing, ready, paused, null)):
                element = make(properties)
                for state in (*way, null):
                    self.assertEqual(element.set_state(state), Gst.StateChangeReturn.SUCCESS, (properties, state))
                    self.assertEqual(element.get_state(0)[:2], (Gst.StateChangeReturn.SUCCESS, state))
                self.assertEqual(element.ref_count, 1)


class Traces(ElementCase):
    def test_it_has_a_header_and_a_row_a_frame(self):
        self.open(f"device=none motion=mean trace={self.path('trace.csv')}")
        self.push(3)
        said = self.messages()
        self.element.get_parent().set_state(Gst.State.NULL)
        names, *rows = csv.reader(self.path("trace.csv").read_text().splitlines())
        self.assertEqual(",".join(names), "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
                         "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,no_force_reason,device_no_force_reason")
        said = [[message.get_value(name) for name in ("running-time", "stream-time", "features", "tracked", "velocity-x",
                                                      "velocity-y", "force-x", "force-y", "no-force-reason")]
                for message in said]
        # Written with the digits that reading back needs: equal, not near.
        self.assertEqual([[*map(float, row[:8]), row[12]] for row in rows], said)
        self.assertEqual([row[13] for row in rows], ["no-device"] * 3)

    def test_what_cannot_be_written_is_a_warning_and_the_video_goes_on(self):
        full = self.path("full.csv")
        full.symlink_to("/dev/full")
        kept, link = self.path("kept.csv"), self.path("link.csv")
        kept.write_text("as it was")
        link.symlink_to(kept)
        pipe = self.path("pipe.jsonl")
        os.mkfifo(pipe, 0o600)
        for properties, said in (("device=none trace=/nowhere/trace.csv", "/nowhere/trace.csv"),
                                 (f"device=none trace={full}", os.strerror(errno.ENOSPC)),
                                 (f"device=none trace={link}", "it is a link"),
                                 (f"device=none trace={pipe}", "a pipe that nobody reads"),
                                 (f"device=sim haptic-trace={pipe}", "a pipe that nobody reads"),
                                 (f"device=none trace={self.path('trace.txt')}", "neither in .csv nor in .jsonl"),
                                 ("device=none haptic-trace=ticks.csv", "device=none opens none"),
                                 ("device=sim haptic-trace=/nowhere/haptic.csv", "/nowhere/haptic.csv"),
                                 ("device=sim haptic-trace=/dev/full", os.strerror(errno.ENOSPC))):
            self.open(properties, 64, 64)
            warnings = []
            while not warnings:  # a thread of its own writes haptic traces
                self.push(3)
                warnings += self.warnings()
            self.push(3)
            self.assertEqual(len(warnings + self.warnings()), 1, warnings)
            self.assertIn(said, warnings[0])
            if "device=sim" in properties:
                self.assertEqual(self.stats("device"), ["sim"], "the force goes on")
        self.assertFalse(self.path("trace.txt").exists())
        self.assertEqual(kept.read_text(), "as it was")


class Stats(ElementCase):
    def test_the_model_of_the_background_is_named(self):
        self.open("device=none motion=camera")
        self.push(3, 3)
        self.assertEqual(self.stats("model", "objects"), ["translation", 0])
        self.assertLess(self.messages()[-1].get_value("velocity-x"), 0)  # the picture goes right, the camera left

    def test_frames_are_counted_and_the_device_is_named(self):
        self.open("device=sim motion=mean")
        self.push(5, 1)
        # The first frame restarts.
        self.assertEqual(self.stats("frames", "restarts", "model", "device"), [5, 1, "none", "sim"])
        tracked, scheduling = self.stats("tracked", "scheduling")
        self.assertGreater(tracked, 20)
        self.assertTrue(scheduling)


if __name__ == "__main__":
    unittest.main()
