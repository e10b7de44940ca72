# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Common players and sources in real time. Nothing depends on the speed of the machine: frames arrive, a force is felt,
and every tick is checked."""

import gc
import importlib
import os
import random
import shutil
import signal
import sys
import threading
import time
import unittest

import gst_case
from gst_case import Gst

# A picture that goes to the left as a whole: JPEG leaves little of a ball to follow.
PAN = ("videotestsrc pattern=smpte horizontal-speed=2 num-buffers=15 ! video/x-raw,width=160,height=120,framerate=30/1 ! "
       "jpegenc ")
SMALL_BALL = "videotestsrc pattern=ball ! video/x-raw,width=160,height=120 ! "
MOTION = "spidarmotion motion=mean "
PLAYBINS = ("playbin", "playbin3")


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


GES, GstPlay = library("GES"), library("GstPlay")


class Players(gst_case.GstCase):
    def make_clip(self):
        """Half a second with sound."""
        self.gst(PAN, "! matroskamux name=m ! filesink location=film.mkv audiotestsrc num-buffers=22 !",
                 "audio/x-raw,rate=44100 ! m.")
        return Gst.filename_to_uri(str(self.path("film.mkv")))

    def expect_felt(self, outcome, frames):
        self.assertEqual((outcome.error, outcome.warnings), ("", []))
        self.assertEqual(len(outcome.forces), frames)
        self.assertGreater(outcome.largest_N, .1)

    def make_player(self, name, uri, sink="fakesink sync=true"):
        player = self.watch(Gst.ElementFactory.make(name))
        for prop, value in (("uri", uri), ("video-filter", Gst.parse_launch(MOTION)),
                            ("video-sink", Gst.parse_launch(sink)), ("audio-sink", Gst.parse_launch("fakesink"))):
            player.set_property(prop, value)
        return player

    def test_playbin(self):
        uri = self.make_clip()
        for name in PLAYBINS:
            self.expect_felt(self.play(self.make_player(name, uri)), 15)

    def test_steps_over_frames(self):
        """The first ten frames are stepped over: the force begins with the eleventh."""
        uri = self.make_clip()
        for name in PLAYBINS:
            player = self.make_player(name, uri)
            player.set_state(Gst.State.PAUSED)
            player.get_state(Gst.CLOCK_TIME_NONE)
            player.get_property("video-sink").send_event(Gst.Event.new_step(Gst.Format.BUFFERS, 10, 1, True, False))
            player.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.STEP_DONE)
            self.assertTrue(self.play(player).eos)
            playing = [int(row["running_ns"]) for row in gst_case.read_ticks(player.watched[-1]) if row["playing"] == "1"]
            self.assertGreaterEqual(playing[0], 10 * Gst.SECOND // 30 - Gst.MSECOND)

    def test_decodebin(self):
        self.make_clip()
        self.expect_felt(self.play(f"filesrc location={self.path('film.mkv')} ! decodebin name=d d. ! queue ! videoconvert "
                                   f"! {MOTION} ! fakesink d. ! queue ! audioconvert ! fakesink"), 15)

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

    def test_stopped_by_another_thread_at_any_moment(self):
        chance = random.Random(3)
        for run in range(40):
            with self.subTest(run):
                pipeline = self.parse(SMALL_BALL + "queue ! spidarmotion ! queue ! fakesink sync=true")
                other = threading.Timer(.03 * chance.random(), pipeline.set_state, [Gst.State.NULL])
                other.start()
                pipeline.set_state(Gst.State.PLAYING)
                if chance.random() < .5:
                    pipeline.seek_simple(Gst.Format.TIME, Gst.SeekFlags.FLUSH, Gst.SECOND)
                other.join()
                self.stop(pipeline)

    def test_every_picture_of_videotestsrc(self):
        patterns = Gst.ElementFactory.make("videotestsrc").find_property("pattern").enum_class
        # Newer releases of PyGObject give the class as GLib has it.
        for pattern in range(patterns.n_values if hasattr(patterns, "n_values") else len(patterns.__enum_values__)):
            outcome = self.play(f"videotestsrc num-buffers=5 pattern={pattern} ! "
                                "video/x-raw,width=320,height=240 ! spidarmotion ! fakesink")
            self.assertEqual((outcome.error, outcome.warnings, len(outcome.forces)), ("", [], 5), pattern)

    def test_a_damaged_film(self):
        self.make_film("clip.avi", 30)
        content = bytearray(self.path("clip.avi").read_bytes())
        chance = random.Random(1)
        for at in range(4096, len(content)):
            if chance.random() < 1 / 256:
                content[at] = chance.randrange(256)
        self.path("clip.avi").write_bytes(content)
        outcome = self.play(f"filesrc location={self.path('clip.avi')} ! decodebin ! videoconvert ! spidarmotion ! fakesink")
        self.assertTrue(outcome.eos or outcome.error)

    @unittest.skipUnless(GstPlay, "needs gir1.2-gst-plugins-bad-1.0")
    def test_gst_play(self):
        """Half of it at twice the speed."""
        play = GstPlay.Play.new(None)
        pipeline = self.watch(play.get_pipeline())
        pipeline.set_property("video-filter", Gst.parse_launch(MOTION))
        for sink in ("video-sink", "audio-sink"):
            pipeline.set_property(sink, Gst.parse_launch("fakesink sync=true"))
        bus = play.get_message_bus()
        play.set_uri(self.make_clip())
        play.pause()
        ended = False
        while not ended:
            message = bus.timed_pop(Gst.CLOCK_TIME_NONE)
            kind = GstPlay.PlayMessage.parse_type(message)
            self.assertNotEqual(kind, GstPlay.PlayMessage.ERROR, message.get_structure().to_string())
            if (kind == GstPlay.PlayMessage.STATE_CHANGED
                    and GstPlay.PlayMessage.parse_state_changed(message) == GstPlay.PlayState.PAUSED):
                play.set_rate(2.0)
                play.seek(Gst.SECOND // 4)
                play.play()
            ended = kind == GstPlay.PlayMessage.END_OF_STREAM
        play.stop()
        pipeline.get_state(Gst.CLOCK_TIME_NONE)
        self.stop(pipeline)
        self.expect_trace(pipeline.watched[-1])

    def expect_trace(self, path):
        """Something was felt, and has ramped down when the element is closed."""
        forces = [max(map(abs, gst_case.vector(row, "commanded_force"))) for row in gst_case.read_ticks(path)]
        self.assertGreater(max(forces), .1)
        self.assertLess(forces[-1], .01)

    @unittest.skipUnless(shutil.which("gst-play-1.0"), "needs gstreamer1.0-plugins-base-apps")
    def test_gst_play_1_0(self):
        """It has no option for a filter, but takes a sink of several elements."""
        self.make_clip()
        self.run_in_folder(["gst-play-1.0", "--quiet", "--no-interactive", "--audiosink=fakesink",
                            f"--videosink={MOTION} haptic-trace=t.csv ! fakesink sync=true", "film.mkv"], timeout=60)
        self.expect_trace(self.path("t.csv"))

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
        # Of 60 frames; the last is at its end, and the first may be over when the first tick comes.
        self.assertGreater(len(reached), 40)
        self.assertGreater(max(reached), 1.9e9)


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
