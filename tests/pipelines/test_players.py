# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Sources that are no files, editing, GL, and what is left in an application's process; players of films are in tests/films. In
real time. Nothing depends on the speed of the machine: frames arrive, a force is felt, and every tick is checked."""

import gc
import importlib
import os
import signal
import sys
import time
import unittest

import gst_case
from gst_case import Gst

SMALL_BALL = "videotestsrc pattern=ball ! video/x-raw,width=160,height=120 ! "
MOTION = "spidarmotion motion=mean "


def needs(*names):
    absent = [name for name in names if not Gst.ElementFactory.find(name)]
    return unittest.skipIf(absent, f"there is no {', '.join(absent)}")


def library(name):
    """A library of GStreamer's, or None."""
    try:
        gst_case.gi.require_version(name, "1.0")
        return importlib.import_module("gi.repository." + name)
    except (ImportError, ValueError):
        return None


GES = library("GES")


class Players(gst_case.GstCase):
    def expect_felt(self, outcome, frames):
        self.assertEqual((outcome.error, outcome.warnings), ("", []))
        self.assertEqual(len(outcome.forces), frames)
        self.assertGreater(outcome.largest_N, .1)

    def test_a_live_source_that_stamps_its_frames_as_a_camera_does(self):
        self.expect_felt(self.play("videotestsrc is-live=true do-timestamp=true pattern=ball ! "
                                   "video/x-raw,width=160,height=120,framerate=60/1 ! queue ! videoconvert ! "
                                   "spidarmotion ! fakesink sync=true", 12), 12)

    def test_rtp(self):
        receiver = self.parse(
            "udpsrc name=source address=127.0.0.1 port=0 caps=\"application/x-rtp,media=video,clock-rate=90000,"
            "encoding-name=JPEG,payload=26\" ! rtpjitterbuffer latency=50 ! rtpjpegdepay ! jpegdec ! "
            f"{MOTION} ! fakesink sync=true")
        source = receiver.get_by_name("source")
        source.set_state(Gst.State.READY)
        sender = Gst.parse_launch(
            "videotestsrc is-live=true pattern=ball ! video/x-raw,format=I420,width=160,height=120,framerate=30/1 ! "
            f"jpegenc ! rtpjpegpay ! udpsink host=127.0.0.1 port={source.get_property('port')}")
        sender.set_state(Gst.State.PLAYING)
        self.expect_felt(self.play(receiver, 10), 10)
        sender.set_state(Gst.State.NULL)

    def test_uridecodebin_with_a_live_source(self):
        """A camera of an application's: a bright square that moves to the right, when it is asked for."""
        pipeline = self.parse("uridecodebin uri=appsrc:// name=d ! queue ! videoconvert ! spidarmotion ! fakesink sync=true")
        frames = iter(range(20))

        def push(source, _length):
            n = next(frames, None)
            if n is None:
                source.emit("end-of-stream")
                return
            time.sleep(.01)
            line = bytes([16]) * 160
            bright = line[:20 + 3 * n] + bytes([200]) * 40 + line[60 + 3 * n:]
            source.emit("push-buffer", Gst.Buffer.new_wrapped(line * 40 + bright * 40 + line * 40))

        def set_up(_decoder, source):
            for prop, value in (("caps", Gst.Caps.from_string("video/x-raw,format=GRAY8,width=160,height=120,framerate=0/1")),
                                ("is-live", True), ("do-timestamp", True), ("format", Gst.Format.TIME)):
                source.set_property(prop, value)
            # Not before: what is pushed before PLAYING has a time stamp of a clock without a base time.
            source.connect("need-data", push)

        pipeline.get_by_name("d").connect("source-setup", set_up)
        outcome = self.play(pipeline)
        self.assertTrue(outcome.eos)
        self.expect_felt(outcome, 20)

    @unittest.skipUnless(GES, "needs gir1.2-ges-1.0")
    def test_a_timeline_of_ges(self):
        """As an effect of a clip, the element warns that it is in the wrong place; after the timeline it works."""
        GES.init()
        trace = self.path("t.csv")
        for effect, sink in ((MOTION, "fakesink sync=true"),
                             (None, f"{MOTION} haptic-trace={trace} ! queue ! fakesink sync=true")):
            timeline = GES.Timeline.new()
            timeline.add_track(GES.VideoTrack.new())
            layer = timeline.append_layer()
            for second in range(2):
                clip = GES.TestClip.new()
                clip.props.vpattern = GES.VideoTestPattern.SMPTE
                clip.props.start = second * Gst.SECOND
                clip.props.duration = Gst.SECOND
                layer.add_clip(clip)
                self.assertTrue(not effect or clip.add(GES.Effect.new(effect)))
            pipeline = GES.Pipeline()
            pipeline.set_timeline(timeline)
            pipeline.props.video_sink = Gst.parse_bin_from_description(sink, True)
            pipeline.set_mode(GES.PipelineFlags.VIDEO_PREVIEW)
            outcome = self.play(self.watch(pipeline))
            self.assertTrue(outcome.eos, outcome.error)
            self.assertEqual(any("timeline" in warning for warning in outcome.warnings), effect is not None)
        reached = {int(row["frame_ns"]) for row in gst_case.read_ticks(trace) if row["playing"] == "1"}
        self.assertGreater(max(reached), 1e9, "the second clip, too")


class Gl(gst_case.GstCase):
    """Pictures in the memory of a graphics card, without a display. Mesa's renderer in software will do."""
    FILM = "videotestsrc pattern=ball num-buffers=10 ! video/x-raw,format=I420,width=320,height=240,framerate=25/1 ! "
    UPLOADED = "glupload ! video/x-raw(memory:GLMemory) ! "

    @needs("glupload", "gldownload", "glcolorconvert", "glcolorscale")
    def test_memory_of_gl(self):
        # Nothing of this project is in it: what fails here does so for others, too.
        without = self.play(self.FILM + "glupload ! glcolorconvert ! gldownload ! fakesink")
        if not without.eos:
            self.skipTest(f"GL does not work here: {without.error}")
        motion = MOTION + "filter-min-cutoff=0 ! "
        plain = self.play(self.FILM + motion + "fakesink")
        self.assertGreater(plain.largest_N, 0)
        downloaded = self.play(self.FILM + self.UPLOADED + "gldownload ! " + motion + "fakesink")
        self.assertEqual(downloaded.forces, plain.forces)
        onwards = self.play(self.FILM + motion + "glupload ! glcolorconvert ! video/x-raw(memory:GLMemory),format=RGBA ! "
                            "fakesink")
        self.assertTrue(onwards.eos, onwards.error)
        with self.assertRaisesRegex(gst_case.gi.repository.GLib.GError, "could not link .*spidarmotion"):
            Gst.parse_launch(self.FILM + self.UPLOADED + motion + "fakesink")


class Process(gst_case.GstCase):
    """What the element leaves behind in an application's process, and what its threads do there."""

    def test_threads_take_no_signals(self):
        """Signals that an application waits for must not end up in a thread that it does not know."""
        pipeline = self.parse(SMALL_BALL + "spidarmotion ! fakesink sync=true")
        pipeline.set_state(Gst.State.PLAYING)
        blocked = {}
        # A thread gives itself its name; the test's own time limit is the only one.
        while not blocked.keys() >= {"spidar-haptic", "spidar-clock", "spidar-trace"}:
            for task in os.listdir("/proc/self/task"):
                with open(f"/proc/self/task/{task}/status", encoding="ascii") as file:
                    status = dict(line.rstrip("\n").split(":\t", 1) for line in file if ":\t" in line)
                if status["Name"].startswith("spidar-"):
                    blocked[status["Name"]] = int(status["SigBlk"], 16)
        unblockable = {signal.SIGKILL, signal.SIGSTOP}
        for name, signals in blocked.items():
            for number in set(range(1, 32)) - unblockable:
                self.assertTrue(signals >> (number - 1) & 1, f"{name}, signal {number}")
        self.stop(pipeline)

    def objects_alive(self, *arguments):
        """What GStreamer's leak tracer finds when this program has run with these arguments."""
        env = dict(os.environ, GST_TRACERS="leaks", GST_DEBUG="GST_TRACER:7", GST_DEBUG_NO_COLOR="1")
        said = self.run_in_folder([sys.executable, os.path.abspath(__file__), "cycles", *arguments], env=env)
        return [line for line in said.splitlines() if " TRACE " in line and "object-alive, " in line]

    def test_cycles_of_start_and_stop_leak_nothing(self):
        self.assertEqual(self.objects_alive(), [])
        self.assertNotEqual(self.objects_alive("leak"), [], "an object that is leaked is seen")


def run_cycles():
    """Pipelines that start, stop, start again and play to the end of the stream, three times each. Python keeps what is on
    its stack; GStreamer reports what is alive when it is deinitialised."""
    for motion in ("spidarmotion", "spidarmotion overlay=points attach-meta=true", "spidarmotion device=none mute=true"):
        for _ in range(3):
            pipeline = Gst.parse_launch(f"videotestsrc num-buffers=8 pattern=ball ! video/x-raw,width=320,height=240 ! "
                                        f"videoconvert ! {motion} ! queue ! fakesink sync=false")
            for state in (Gst.State.PAUSED, Gst.State.READY, Gst.State.NULL, Gst.State.PAUSED, Gst.State.PLAYING):
                pipeline.set_state(state)
                assert pipeline.get_state(Gst.CLOCK_TIME_NONE)[0] == Gst.StateChangeReturn.SUCCESS
            pipeline.seek_simple(Gst.Format.TIME, Gst.SeekFlags.FLUSH, 0)
            assert pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, gst_case.ENDS).type == Gst.MessageType.EOS
            pipeline.set_state(Gst.State.NULL)
            del pipeline


if __name__ == "__main__":
    if sys.argv[1:2] == ["cycles"]:
        run_cycles()
        leaked = Gst.ElementFactory.make("spidarmotion") if sys.argv[2:] else None
        gc.collect()
        Gst.deinit()
        os._exit(0)
    unittest.main()
