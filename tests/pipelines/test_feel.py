# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel with players that are separate programs, and an SH4 board on an emulated USB."""

import csv
import json
import pathlib
import shutil
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import unittest

import bus_case
import track_case
from bus_case import FEEL, PROFILE, Evdev, bus

HERE = pathlib.Path(__file__).parent
PLAYER = [sys.executable, HERE / "feel_player.py"]
PLAYBINS = ("playbin", "playbin3")
QUIET = ("gst-play-1.0", "-q", "--no-interactive", "--audiosink=fakesink")

ONLY_WHICH = r"\Aspidar-feel: usb: at 1-1: CyVerse USB 2.0 SH4, rotary switch 0. It renders force [^\n]*\n" \
    r"spidar-feel: The film has no haptic track or script: its motion is felt.\n\Z"


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
        steps = (f"{step}={self.trace}" if step in ("felt", "rest", "forget") else step for step in steps.split())
        return [*PLAYER, playbin, film or self.film, *steps]

    def run_felt(self, steps, playbin="playbin", film=None, status=0):
        return self.run_all(self.felt(*self.player(steps, playbin, film)), status)


class Feel(FeelCase):
    def setUp(self):
        super().setUp()
        bus.bus_plug(0, b"sh4")

    def test_a_player_is_felt_while_it_plays_and_at_rest_while_paused(self):
        """How soon is a matter of the loop's time: tests/pipelines/test_interruptions.cpp. It says which device that is, and no
        more."""
        for playbin in PLAYBINS:
            with self.subTest(playbin):
                self.assertRegex(self.run_felt("play felt pause rest stop", playbin), ONLY_WHICH)
                self.assertTrue(bus.bus_at_rest(0))

    def test_the_device_is_at_rest_however_the_player_ends(self):
        for end in ("stop", "exit"):
            before = bus.bus_updates(0)
            self.run_felt("play felt " + end)
            self.assertGreater(bus.bus_updates(0), before)
            bus_case.wait_for(lambda: bus.bus_at_rest(0))
        for number in (signal.SIGTERM, signal.SIGKILL):
            self.end_while_felt(self.felt(*self.player("play stay")), number)

    def test_the_next_film_is_felt_too(self):
        self.run_felt("play felt stop forget preroll wait=20 play felt")
        # On a busy machine, a device that was set to rest is opened once more.
        self.assertGreaterEqual(self.opened(), 2)

    def test_a_film_of_ten_bits_with_full_colour_is_converted_for_the_screen(self):
        deep = self.make_film("deep.webm", 50, "vp9enc deadline=1 cpu-used=8 ! webmmux", ",format=Y444_10LE")
        for playbin in PLAYBINS:
            with self.subTest(playbin):
                # Nothing else converts.
                self.run_in_folder(self.player("window play", playbin, deep), status=1)
                self.assertRegex(self.run_felt("window play felt stop", playbin, deep), ONLY_WHICH)

    def test_who_only_looks_or_has_a_motion_of_its_own_opens_no_device(self):
        """As a thumbnailer does."""
        self.assertEqual(self.run_felt("preroll wait=100 loaded"), "loaded\n")
        self.run_felt("own-filter play frames=10")
        self.run_felt("own-sink play wait=500")
        if shutil.which("gst-discoverer-1.0"):
            self.run_all(self.felt("gst-discoverer-1.0", self.make_film("short.avi", 15)))
        self.assertEqual(self.opened(), 0)

    def test_of_two_players_in_a_process_the_first_has_the_device(self):
        self.assertRegex(self.run_felt("play felt other play frames=40 stop"), ONLY_WHICH)
        self.assertTrue(bus.bus_at_rest(0))

    def test_without_it_the_plugin_is_not_loaded(self):
        self.assertEqual(self.run_all(self.player("play frames=10 loaded")), "not loaded\n")
        self.assertEqual(self.opened(), 0)

    def test_what_a_device_cannot_render_is_printed(self):
        bus.evdev_plug(0, Evdev.PAD)
        said = self.run_all([FEEL, "device=ff", "--", *self.player("play frames=10 stop")])
        self.assertEqual(said.splitlines()[0], "spidar-feel: Emulated Pad, rumble only: the strength of the force is felt, "
                         "not its direction.")

    @track_case.needs(QUIET[0])
    def test_a_film_of_an_upright_telephone_is_turned_and_the_next_one_is_not(self):
        """The picture moves to the left, and is shown turned clockwise: upwards."""
        film = self.make_film("stored.mov", 40, "jpegenc ! qtmux").read_bytes()
        # 16.16 and 2.30, in tkhd behind 40 bytes: x to y, and y to -x.
        at = film.index(b"tkhd") + 44
        matrix = struct.pack(">9i", 0, 1 << 16, 0, -1 << 16, 0, 0, 0, 0, 1 << 30)
        turned = self.films / "turned.mov"
        turned.write_bytes(film[:at] + matrix + film[at + len(matrix):])
        trace = self.films / "frames.csv"
        for films, along, sign in (((turned,), "y", 1), ((turned, self.films / "stored.mov"), "x", -1)):
            self.run_all([FEEL, "device=none", "motion=mean", f"trace={trace}", "--", *QUIET, "--videosink=fakesink sync=true", *films])
            with open(trace, newline="", encoding="ascii") as file:  # of the last film
                rows = [row for row in csv.DictReader(file) if row["force_x_N"]]
            for axis in ("x", "y"):
                # Of most frames: a busy machine leaves some out, after which the measuring begins anew.
                velocity_px_s, force_N = (statistics.median(float(row[column]) for row in rows)
                                          for column in (f"velocity_{axis}_px_s", f"force_{axis}_N"))
                if axis == along:
                    self.assertLess(velocity_px_s, -20)  # of 50 px/s
                    self.assertGreater(sign * force_N, .1)  # y of a force points up
                else:
                    self.assertLess(abs(velocity_px_s), 5)
                    self.assertLess(abs(force_N), .05)

    @track_case.needs(QUIET[0])
    def test_a_sentence_says_which_track_or_scripts_are_felt(self):
        film = self.make_film("scripted.avi", 25)
        script, roll, track = (film.with_suffix(end) for end in (".funscript", ".roll.funscript", ".haptic.wav"))

        def expect_said(what):
            said = self.run_all([FEEL, *QUIET, "--videosink=fakesink sync=true", film])
            self.assertEqual(said.count(f"spidar-feel: Felt instead of the film's motion: {what}.\n"), 1, said)

        for path in (script, roll):
            path.write_text(json.dumps({"actions": [{"at": 0, "pos": 90}, {"at": 1000, "pos": 10}]}))
        expect_said(f"{script}: fy, gain 3.3 taken back: 100 % is 3 N; {roll}: tz, gain 10 taken back: 100 % is 0.1 N m")
        track_case.write_wav(track, [(.1,) + (0,) * 5] * 1000)
        expect_said(f"the haptic track {track}")

    @track_case.needs(QUIET[0])
    def test_rules_are_felt_before_a_track_that_lies_beside_the_film_and_a_sentence_says_so(self):
        film = self.make_film("ruled.avi", 25)
        rules, track = film.with_suffix(".feel"), film.with_suffix(".haptic.wav")

        def said(*properties):
            return self.run_all([FEEL, *properties, "--", *QUIET, "--videosink=fakesink sync=true", film])
        unfelt = f"spidar-feel: The haptic track {track} is not felt, because feel= says what is.\n"
        felt = f"spidar-feel: Felt instead of the film's motion: the haptic track {track}.\n"
        self.assertNotIn("haptic track", said("feel=largest"))
        track_case.write_wav(track, [(.1,) + (0,) * 5] * 1000)
        for what, heard, unheard in (("feel=largest", [unfelt], [felt]), ("feel=auto", [felt], [unfelt])):
            with self.subTest(what):
                text = said(what)
                self.assertEqual([text.count(sentence) for sentence in heard + unheard], [1, 0], text)
        rules.write_text("0:00- largest\n")
        text = said("feel=auto")
        self.assertEqual([text.count(unfelt), text.count(felt)], [1, 0], text)
        text = said("feel=auto", f"track={track}")
        self.assertEqual([text.count(unfelt), text.count(felt)], [0, 1], text)


class NoDevice(FeelCase):
    @track_case.needs(QUIET[0])
    def test_sound_is_said_to_have_no_video(self):
        subprocess.run(["gst-launch-1.0", "-q", "audiotestsrc", "num-buffers=20", "!", "wavenc", "!", "filesink",
                        f"location={self.films / 'sound.wav'}"], check=True)
        for playbin in PLAYBINS:
            with self.subTest(playbin):
                chosen = "--use-playbin3" if playbin == "playbin3" else "--quiet"
                said = self.run_all([FEEL, *QUIET, chosen, self.films / "sound.wav"])
                self.assertIn("spidar-feel: there is no video in it, so nothing is felt", said)
        self.assertNotIn("no video", self.run_all([FEEL, *QUIET, "--videosink=fakesink", self.make_film("short.avi", 15)]))

    @track_case.needs(QUIET[0])
    def test_what_cannot_be_played_or_shown_is_said(self):
        no_film = self.films / "text.avi"
        no_film.write_text("no film")
        films = (self.make_film("short.avi", 15), no_film)
        self.run_all([FEEL, *QUIET, "--videosink=fakesink", *films[:1]])
        self.run_all([FEEL, *QUIET, "--videosink=fakesink", *films], status=1)
        screenless = f"DISPLAY= WAYLAND_DISPLAY= {FEEL} device=none trace={self.path('trace.csv')} -- {films[0]} "
        self.assertIn("there is no screen for the film", self.run_in_folder(screenless))
        self.assertGreater(len(self.path("trace.csv").read_text(encoding="ascii").splitlines()), 1, "no frame was played")
        self.assertNotIn("there is no screen", self.run_in_folder(screenless + "--videosink='fakesink sync=true'"))

    def test_a_player_plays_without_a_device_that_can_be_opened(self):
        film = self.make_film("very_short.avi", 15)
        said = self.run_felt("play end", film=film)
        self.assertRegex(said, "^spidar-feel: .*usb.*[^.]\\. The video goes on without force\\.\n")
        alone = self.run_all(self.player("play end", film=film))
        self.assertTrue(alone.startswith("15 frames, "), alone)
        self.assertIn(alone, said)

    def test_without_a_device_the_picture_shows_what_would_be_felt(self):
        film = self.make_film("short.avi", 50)

        def shown(*properties):
            said = self.run_all([FEEL, *properties, "--", *self.player("play end", film=film)])
            return said.splitlines()[-1].split(", ")[1]
        alone = self.run_all(self.player("play end", film=film)).strip().split(", ")[1]
        for device in ((), ("device=sim",), ("device=sim:sh4",)):
            self.assertNotEqual(shown(*device), alone)
            self.assertEqual(shown(*device, "overlay=none"), alone)
        bus.bus_plug(0, b"sh4")
        self.assertEqual(shown("device=usb", PROFILE), alone)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        unittest.main()
    # Each class in a process of its own, and on a bus of its own, at the same time: players mostly wait.
    running = [subprocess.Popen([sys.executable, __file__, case.__name__]) for case in (Feel, NoDevice)]
    sys.exit(max(process.wait() for process in running))
