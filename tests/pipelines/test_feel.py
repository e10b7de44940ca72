# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel with players that are separate programs, and an SH4 board on an emulated USB."""

import itertools
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import bus_case
import track_case
from bus_case import FEEL, PROFILE, Evdev, Usb, bus

HERE = pathlib.Path(__file__).parent
PLAYER = [sys.executable, HERE / "feel_player.py"]
PLAYBINS = ("playbin", "playbin3")
DECODERS = ("uridecodebin", "uridecodebin3", "decodebin", "decodebin3")
QUIET = ("gst-play-1.0", "-q", "--no-interactive", "--audiosink=fakesink")
DOES_NOT_FIT = "spidar-feel: the video does not fit through the filter and is not felt\n"


class FeelCase(bus_case.BusCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.films = pathlib.Path(folder.name)
        cls.film = cls.make_film("film.avi", 1500)  # a minute

    @classmethod
    def make_film(cls, name, frames, encoder="jpegenc ! avimux", caps=""):
        """A picture that moves as a whole, 25 frames/s; once for all tests."""
        film = cls.films / name
        if not film.exists():
            subprocess.run(["gst-launch-1.0", "-q", *f"videotestsrc pattern=smpte horizontal-speed=2 num-buffers={frames} ! "
                            f"video/x-raw{caps},width=160,height=120,framerate=25/1 ! {encoder} ! filesink "
                            f"location={film}".split()], check=True)
        return film

    def player(self, steps, playbin="playbin", film=None):
        return [*PLAYER, playbin, film or self.film, *steps.split()]

    def run_felt(self, steps, playbin="playbin", film=None, status=0):
        return self.run_all(self.felt(*self.player(steps, playbin, film)), status)


class Feel(FeelCase):
    def setUp(self):
        super().setUp()
        bus.bus_plug(0, Usb.SH4)

    def test_a_player_is_felt_while_it_plays_and_at_rest_while_paused(self):
        """From 60 ms after the pause on. It has nothing to say."""
        for playbin in PLAYBINS + DECODERS:
            with self.subTest(playbin):
                self.assertEqual(self.run_felt("play frames=20 pause wait=200 stop", playbin), "")
                self.expect_felt()
                ticks = bus_case.read_trace(self.trace)
                last_s = max(time for time, _, _, playing in ticks if playing)
                rest = [force for time, _, force, _ in ticks if time > last_s + .06]
                self.assertTrue(rest)
                self.assertEqual(max(rest), 0)

    def test_the_device_is_at_rest_however_the_player_ends(self):
        for end in ("stop", "exit"):
            before = bus.bus_updates(0)
            self.run_felt("play frames=30 " + end)
            self.assertGreater(bus.bus_updates(0), before)
            bus_case.wait_for(lambda: bus.bus_at_rest(0))
        launched = f"gst-launch-1.0 -q uridecodebin uri=file://{self.film} ! videoconvert ! fakevideosink".split()
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
            for command in (self.player("play stay"), launched):
                self.end_while_felt(self.felt(*command), number)
        if shutil.which(QUIET[0]):
            for number in (signal.SIGTERM, signal.SIGINT):
                self.end_while_felt(self.felt(*QUIET, "--videosink=fakesink sync=true", self.film), number)

    def test_the_next_film_is_felt_too(self):
        self.run_felt("play frames=10 stop preroll wait=20 play frames=40")
        self.assertEqual(self.opened(), 2)
        self.expect_felt()

    def test_a_film_of_ten_bits_with_full_colour_is_converted_for_the_screen(self):
        deep = self.make_film("deep.webm", 50, "vp9enc deadline=1 cpu-used=8 ! webmmux", ",format=Y444_10LE")
        for playbin in PLAYBINS:
            with self.subTest(playbin):
                steps = "window play frames=30 stop"
                # Nothing else converts.
                self.run_in_folder(["timeout", "20", *self.player(steps, playbin, deep)], status=1)
                self.assertEqual(self.run_felt(steps, playbin, deep), "")
                self.expect_felt()

    def test_who_only_looks_or_has_a_motion_of_its_own_opens_no_device(self):
        """As a thumbnailer does."""
        self.assertEqual(self.run_felt("preroll wait=100 loaded"), "loaded\n")
        self.run_felt("own-filter play frames=10")
        self.run_felt("own-sink play wait=500")
        for decoder in ("uridecodebin", "decodebin3"):
            self.run_felt("preroll wait=100", decoder)
            self.run_felt("own-sink play frames=10", decoder)
        short = self.make_film("short.avi", 15)
        for sink in ("vp8enc deadline=1 ! webmmux ! filesink location=other.webm", "fakesink sync=true"):
            self.run_all(self.felt(*f"gst-launch-1.0 -q uridecodebin uri=file://{short} ! videoconvert ! {sink}".split()))
        if shutil.which("gst-discoverer-1.0"):
            self.run_all(self.felt("gst-discoverer-1.0", short))
        self.assertEqual(self.opened(), 0)

    def test_a_timeline_is_left_alone(self):
        self.run_all(self.felt(sys.executable, HERE / "felt_timeline.py", self.film), None)
        if self.status == 77:
            self.skipTest("GES is not installed: gir1.2-ges-1.0")
        self.assertEqual((self.status, self.opened()), (0, 0))

    def test_of_two_players_in_a_process_the_first_has_the_device(self):
        for playbin in ("playbin", "uridecodebin"):
            before = self.opened()
            self.assertEqual(self.run_felt("play frames=15 other play frames=40 stop", playbin), "")
            self.assertEqual(self.opened() - before, 1)
            self.assertTrue(bus.bus_at_rest(0))

    def test_without_it_the_plugin_is_not_loaded(self):
        self.assertEqual(self.run_all(self.player("play frames=10 loaded")), "not loaded\n")
        self.assertEqual(self.opened(), 0)

    def test_what_a_device_cannot_render_is_printed(self):
        bus.evdev_plug(0, Evdev.PAD)
        self.assertEqual(self.run_all([FEEL, "device=ff", "--", *self.player("play frames=10 stop")]),
                         "spidar-feel: Emulated Pad, rumble only: the strength of the force is felt, not its direction.\n")

    @track_case.needs(QUIET[0])
    def test_every_film_of_a_gapless_list_is_felt_to_its_end(self):
        short = self.make_film("short.avi", 50)
        for playbin in ("--use-playbin3", "--quiet"):
            with self.subTest(playbin):
                # In the queue, the last second of a film waits while the next one arrives.
                self.run_all([FEEL, "motion=mean", f"haptic-trace={self.trace}", "--", *QUIET, "--gapless", playbin,
                              "--videosink=queue ! fakesink sync=true", short, short])
                ticks = bus_case.read_trace(self.trace)
                # The device opens when the first second has passed the element already.
                for from_s in (1.2, 2.2, 3.2):
                    felt_N = max(force for _, running, force, playing in ticks if playing and 0 <= running - from_s < .7)
                    self.assertGreater(felt_N, .1, f"from {from_s} s on")


class Decoders(FeelCase):
    """Of players without playbin."""
    def setUp(self):
        super().setUp()
        self.short = self.make_film("very_short.avi", 15)

    def shown_alone(self):
        """What a player shows by itself."""
        shown = self.run_all(self.player("play end", "uridecodebin", self.short))
        self.assertTrue(shown.startswith("15 frames, "), shown)
        return shown

    def test_they_are_felt_again_after_seeks_pauses_and_stops(self):
        bus.bus_plug(0, Usb.SH4)
        # After READY, decodebin3 of GStreamer 1.22 fails, without spidar-feel, too.
        for decoder in ("uridecodebin", "uridecodebin3", "decodebin"):
            for end, times in (("pause", 1), ("ready", 2)):
                with self.subTest(decoder, end=end):
                    before = self.opened()
                    steps = f"play frames=3 seek frames=3 {end} play frames=3 seek frames=10"
                    self.assertEqual(self.run_felt(steps, decoder), "")
                    self.assertEqual(self.opened() - before, times)
                    self.expect_felt()

    def test_they_are_felt_when_their_pad_is_replaced_while_they_play(self):
        chain = self.path("chain.ogg")
        # Each part with a serial number of its own. The decoder lets the sink crop the frames.
        chain.write_bytes(b"".join(self.make_film(name, 15, "theoraenc ! oggmux").read_bytes()
                                   for name in ("first.ogg", "second.ogg")))
        bus.bus_plug(0, Usb.SH4)
        # The others do not play such a film, without spidar-feel, too.
        for decoder in ("uridecodebin", "decodebin"):
            with self.subTest(decoder):
                alone = self.run_all(self.player("play end", decoder, chain))
                self.assertTrue(alone.startswith("30 frames, "), alone)
                before = self.opened()
                self.assertEqual(self.run_felt("play end", decoder, chain), alone)
                self.assertEqual(self.opened() - before, 2)
                # The second part's decoder waits for its pad when the filter is to be put in.
                self.assertEqual(self.run_felt("slow-pads play end", decoder, chain), alone)
                self.expect_felt()  # the second part; the first part's trace was replaced

    def test_they_need_not_allocate_anew_during_seeks(self):
        bus.bus_plug(0, Usb.SH4)
        theora = self.make_film("theora.ogg", 15, "theoraenc ! oggmux")
        for wait in (20, 40, 60, 80):
            self.run_felt(f"play wait={wait} seek seek seek end", "decodebin", theora)

    def test_they_show_the_same_frames_also_when_the_filter_does_not_fit(self):
        bus.bus_plug(0, Usb.SH4)
        alone = self.shown_alone()
        for decoder in DECODERS:
            with self.subTest(decoder):
                self.assertEqual(self.run_felt("play end", decoder, self.short), alone)
                self.expect_felt()
                refused = self.run_felt("preroll refuse play end", decoder, self.short)
                self.assertEqual(refused, DOES_NOT_FIT + alone)
                self.assertTrue(bus.bus_at_rest(0))

    def test_without_a_device_that_can_be_opened_they_play(self):
        said = self.run_felt("play end", "uridecodebin", self.short)
        self.assertRegex(said, "^spidar-feel: .*usb")
        self.assertIn(self.shown_alone(), said)
        self.assertRegex(self.run_felt("play end", "playbin", self.short), "^spidar-feel: .*usb")

    def test_those_of_gst_launch(self):
        bus.bus_plug(0, Usb.SH4)
        short = self.make_film("short.avi", 50)
        for source in (f"uridecodebin uri=file://{short}", f"uridecodebin3 uri=file://{short}",
                       f"filesrc location={short} ! decodebin", f"filesrc location={short} ! decodebin3",
                       # Its pad appears while the pipeline plays.
                       "videotestsrc is-live=true horizontal-speed=2 num-buffers=50 ! video/x-raw,width=160,height=120,"
                       "framerate=25/1 ! jpegenc ! decodebin"):
            with self.subTest(source):
                self.run_all(self.felt(*f"gst-launch-1.0 -q {source} ! videoconvert ! fakevideosink".split()))
                self.expect_felt()
        # The decoder takes the filter out again.
        self.run_all(self.felt(*"gst-launch-1.0 -q videotestsrc num-buffers=15 ! video/x-raw,width=160,height=120,"
                               "framerate=25/1 ! decodebin3 ! fakevideosink".split()))
        self.assertTrue(bus.bus_at_rest(0))


class Sizes(FeelCase):
    """Films with frames of sizes that spidarmotion does not accept."""
    def make_film_of(self, sizes, frames_each):
        """A moving picture in several sizes, one after the other. The file says 320x240, whatever the size: muxers accept
        neither a new size nor one below 16."""
        self.run_in_folder(["gst-launch-1.0", "-q", *"concat name=all ! webmmux ! filesink location=sizes.webm".split(), *(
            word for width, height in sizes for word in (
                f"videotestsrc pattern=smpte horizontal-speed=2 num-buffers={frames_each} ! video/x-raw,width={width},"
                f"height={height},framerate=25/1 ! vp8enc deadline=1 cpu-used=8 ! capssetter replace=true "
                "caps=video/x-vp8,width=320,height=240,framerate=25/1,profile=(string)0 ! all.").split())])
        return self.path("sizes.webm")

    def expect_said(self, playbin, film, size, frames):
        said = self.run_all([FEEL, "device=sim", "motion=mean", f"haptic-trace={self.trace}", "--",
                             *self.player("play end stop", playbin, film)])
        self.assertTrue(said.startswith(f"spidar-feel: frames of {size} pixels are not felt; "), said)
        self.assertIn(f"\n{frames} frames, ", said)

    def test_a_film_that_is_too_small_or_too_large_plays(self):
        for width, height in ((8, 8), (8208, 16)):
            # They last two seconds, so that the device is open before the last of them.
            self.expect_said("playbin3", self.make_film_of([(width, height)], 50), f"{width}x{height}", 50)
            self.assertEqual(bus_case.largest_N(bus_case.read_trace(self.trace)), 0)

    def test_what_fits_is_felt_before_and_after_frames_that_do_not(self):
        self.expect_said("playbin", self.make_film_of([(320, 240), (8, 8), (320, 240)], 25), "8x8", 75)
        ticks = bus_case.read_trace(self.trace)
        parts_N = [bus_case.largest_N(part) for playing, part in itertools.groupby(ticks, lambda tick: tick[3]) if playing]
        self.assertGreaterEqual(len(parts_N), 2)
        self.assertGreater(min(parts_N[0], parts_N[-1]), .1)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        unittest.main()
    # Each class in a process of its own, and on a bus of its own, at the same time: players mostly wait.
    running = [subprocess.Popen([sys.executable, __file__, case.__name__]) for case in (Feel, Decoders, Sizes)]
    sys.exit(max(process.wait() for process in running))
