#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What applications ask of the elements before they play, and what they are told when nothing plays. The argument is the
file of presets."""
import os
import pathlib
import subprocess
import sys
import unittest

os.environ["GST_PRESET_PATH"] = str(pathlib.Path(sys.argv.pop(1)).parent)
import gst_case  # noqa: E402
from gst_case import Gst  # noqa: E402
from gi.repository import GObject  # noqa: E402

LIVE = "videotestsrc num-buffers=50 ! spidarmotion device=none attach-meta=true ! spidarextract name=x "


class Inspected(gst_case.GstCase):
    def exists(self, *options):
        return subprocess.run(["gst-inspect-1.0", "--exists", *options, "spidarmotion"], check=False).returncode == 0

    def test_the_element_exists_in_the_version_of_the_project(self):
        self.assertTrue(self.exists("--atleast-version=0.1"))
        self.assertFalse(self.exists("--atleast-version=99.0"))

    def test_presets_have_the_values_that_they_are_called_after(self):
        element = Gst.ElementFactory.make("spidarmotion")
        names = [spec.name for spec in element.list_properties() if spec.flags & GObject.ParamFlags.WRITABLE]

        def values():
            return {name: element.get_property(name) for name in names}

        new = values()
        self.assertEqual(sorted(element.get_preset_names()), ["film", "gentle", "paper"])
        self.assertTrue(element.load_preset("paper"))
        self.assertEqual(values(), {**new, "motion": 0, "alpha": 0.01, "depth-gain": 0, "roll-gain": 0,
                                    "filter-min-cutoff": 0})
        self.assertTrue(element.load_preset("gentle"))
        self.assertEqual(values(), {**new, "alpha": 0.00083})
        self.assertTrue(element.load_preset("film"))
        self.assertEqual(values(), new)

    def test_a_preset_leaves_the_largest_force_as_it_is(self):
        for line in ("max-force=.5 @preset=paper", "@preset=gentle max-force=.5", "max-force=.5 @preset=film"):
            self.assertEqual(Gst.parse_launch(f"spidarmotion {line}").get_property("max-force"), .5, line)


class Extract(gst_case.GstCase):
    def test_sinks_that_wait_for_each_other_are_told_of(self):
        pipeline = self.parse(LIVE + "x.src ! fakesink x.wrench ! fakesink")
        pipeline.set_state(Gst.State.PLAYING)
        told = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, gst_case.ENDS | Gst.MessageType.WARNING)
        self.assertEqual(told.type, Gst.MessageType.WARNING)
        self.assertIn("put a queue between spidarextract and the sink of the video", told.parse_warning()[0].message)

    def test_what_is_wrong_with_the_order_is_told(self):
        for line, why in (("spidarextract name=x ! spidarmotion device=none ! fakesink x.wrench ! fakesink",
                           "spidarmotion is behind spidarextract, and belongs in front of it"),
                          ("spidarmotion device=none ! spidarextract name=x ! fakesink x.wrench ! fakesink",
                           "spidarmotion has attach-meta=false"),
                          ("spidarextract name=x ! queue ! fakesink x.wrench ! fakesink",
                           "there is no spidarmotion in front of spidarextract")):
            pipeline = self.parse("videotestsrc ! video/x-raw,width=160,height=120,framerate=25/1 ! " + line)
            pipeline.set_state(Gst.State.PLAYING)
            told = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, gst_case.ENDS | Gst.MessageType.WARNING)
            self.assertEqual(told.type, Gst.MessageType.WARNING)
            message = told.parse_warning()[0].message
            self.assertIn(f"silent where they do: {why}. Right is: … ! spidarmotion attach-meta=true ! spidarextract",
                          message)
            pipeline.set_state(Gst.State.NULL)

    def test_a_trace_is_the_file_of_one_element(self):
        def trace(of):
            return f"spidarmotion device=none trace={self.path(of)}"

        film = "videotestsrc num-buffers=10 ! video/x-raw,width=64,height=48,framerate=25/1 ! "
        outcome = self.play(f"{film} {trace('a.csv')} ! {trace('a.csv')} ! {trace('B.JSONL')} ! fakesink")
        self.assertTrue(outcome.eos, outcome.error)
        self.assertEqual(outcome.warnings, [f"Cannot write the trace '{self.path('a.csv')}': another element or program "
                                            "is writing it; each needs its own file."])
        for name, rows in (("a.csv", 11), ("B.JSONL", 10)):
            self.assertEqual(self.path(name).read_text().count("\n"), rows)
        # It is free again afterwards, and begins anew.
        self.assertEqual(self.play(f"{film} {trace('a.csv')} ! fakesink").warnings, [])
        # A mistyped film leaves it as it is.
        self.assertTrue(self.play(f"filesrc location=none.avi ! decodebin ! {trace('a.csv')} ! fakesink").error)
        self.assertEqual(self.path("a.csv").read_text().count("\n"), 11)

    def test_a_mistyped_film_leaves_the_haptic_trace_of_the_last_one(self):
        film = "videotestsrc num-buffers=5 ! video/x-raw,width=64,height=48,framerate=25/1"
        sound = "audiotestsrc num-buffers=5 ! audio/x-raw,channels=6,channel-mask=(bitmask)0x3f"
        for source, element in ((film, "spidarmotion"), (sound, "spidarsink accept-unmarked=true")):
            trace = self.path(element[:9])
            ours = f"{element} device=sim haptic-trace={trace}" + (" ! fakesink" if source == film else "")
            self.play(f"{source} ! {ours}")
            rows = trace.read_text()
            self.assertGreater(len(rows.splitlines()), 1)
            self.assertTrue(self.play(f"filesrc location=none.avi ! decodebin ! {ours}").error)
            self.assertEqual(trace.read_text(), rows)
            self.play(f"{source} ! {ours}")
            first, second, *_ = trace.read_text().splitlines()
            self.assertEqual((first, second[:2]), (rows.splitlines()[0], "1,"), "it begins anew, with the first tick")

    def test_nothing_is_told_behind_a_queue_or_of_a_pipeline_that_is_paused(self):
        outcome = self.play(LIVE + "x.src ! queue ! fakesink x.wrench ! fakesink")
        self.assertTrue(outcome.eos, outcome.error)
        self.assertEqual(outcome.warnings, [])
        # Longer than what is waited for: the video has been shown, and the application holds it there.
        pipeline = self.parse(LIVE + "x.src ! fakesink x.wrench ! fakesink async=false")
        pipeline.set_state(Gst.State.PAUSED)
        told = pipeline.bus.timed_pop_filtered(1500 * Gst.MSECOND, gst_case.ENDS | Gst.MessageType.WARNING)
        self.assertIsNone(told)


if __name__ == "__main__":
    unittest.main()
