# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel --follow with a player that tells exactly where it is. The haptic track of its film is a force that rises with
the position, so that each tick of the loop tells which position is felt."""

import csv
import json
import math
import os
import shutil
import signal
import socket
import statistics
import subprocess
import threading
import time
import unittest
import unittest.mock

from gi.repository import GLib

import screen
import track_case
from mpris_player import Bus, MockPlayer, interface

FEEL = os.environ["SPIDAR_FEEL"]
LENGTH_S = 60
# Newtons at the beginning, and more each second: within the default max-force, and above what is too weak to be felt.
FORCE_N, SLOPE_N_S = .5, 2 / LENGTH_S
LONGEST_S = 60  # to wait for what hangs
TICKS = 500  # on end, in which it is felt, or at rest
STEP = 50  # ticks, over which the position that is felt goes on
# Of what is felt, from the player: a seek leads farther. The goal of docs/players.md is a matter of the clock, which
# test_position_filter.cpp has, and the suite `players` measures.
NEAR_S = .25


def write_track(path):
    full_N = track_case.FULL_SCALE[0]
    track_case.write_wav(path, [((FORCE_N + SLOPE_N_S * ms / 1000) / full_N, 0, 0, 0, 0, 0)
                                for ms in range(1000 * LENGTH_S)])


def felt_position_s(force_N):
    return (force_N - FORCE_N) / SLOPE_N_S


@unittest.skipUnless(Bus.is_there(), "dbus-daemon is not installed (package dbus-daemon)")
class FollowCase(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.bus = Bus()
        self.addCleanup(self.bus.stop)
        self.film, self.trace, self.log = (self.path(name) for name in ("film.avi", "trace.csv", "log"))
        self.gst(f"videotestsrc num-buffers={10 * LENGTH_S} ! video/x-raw,width=32,height=32,framerate=10/1 ! jpegenc ! "
                 "avimux ! filesink location=film.avi")
        write_track(self.path("film.avi.haptic.wav"))

    def follow(self, *words, properties=(), **variables):
        variables = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "DBUS_SESSION_BUS_ADDRESS": self.bus.address} | variables
        with open(self.log, "w", encoding="utf-8") as log:
            process = subprocess.Popen([FEEL, "device=sim", f"haptic-trace={self.trace}", *properties, "--follow", *words],
                                       stdout=log, stderr=log, cwd=self.folder, env=os.environ | variables)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def said(self):
        return self.log.read_text(encoding="utf-8")

    def wait_until(self, condition):
        """The test has a limit."""
        while not condition():
            time.sleep(.02)

    def force_N(self):
        ticks = self.last_ticks()
        return ticks[-1][2] if ticks else 0

    def last_ticks(self, since_s=0):
        """(monotonic s, N that the track says, N commanded) of up to TICKS ticks at the end of the trace."""
        try:
            with open(self.trace, "rb") as file:
                names = file.readline().decode().strip().split(",")
                file.seek(max(file.tell(), os.stat(self.trace).st_size - 1000 * TICKS))  # a row has less than 1000 bytes
                rows = file.read().decode().split("\n")[1:-1]
        except FileNotFoundError:
            return []
        ticks = [(1e-9 * int(row["monotonic_ns"]), float(row["wanted_force_x_N"]),
                  math.hypot(*(float(row[f"commanded_force_{axis}_N"]) for axis in "xyz")))
                 for row in csv.DictReader(rows, names)]
        return [tick for tick in ticks if tick[0] > since_s][-TICKS:]

    def wait_for_ticks(self, condition):
        """Until it holds for the last TICKS ticks. However long that takes on a busy machine: a minute ends the test."""
        begin_s = time.monotonic()
        while True:
            ticks = self.last_ticks(begin_s)
            if len(ticks) == TICKS and condition(ticks):
                return
            self.assertLess(time.monotonic(), begin_s + LONGEST_S, f"{ticks[-1:]} {self.said()}")
            time.sleep(.1)

    def expect_found(self, player):
        """Near where it is, and as fast, by the times of the ticks; but for moments of rest, as a busy machine causes."""
        def is_there(ticks):
            if player.position_s() > LENGTH_S - 5:
                player.change(position_s=2)  # before the film ends
            felt = [(now_s, felt_position_s(force)) for now_s, force, _ in ticks if force > 0]
            late_s = [abs(player.position_s(now_s) - position_s) for now_s, position_s in felt]
            rates = [(after - before) / (to_s - from_s) for (from_s, before), (to_s, after) in zip(felt, felt[STEP:])]
            return rates and statistics.median(late_s) < NEAR_S and abs(statistics.median(rates) - player.rate) < .1
        self.wait_for_ticks(is_there)

    def expect_rest(self):
        self.wait_for_ticks(lambda ticks: max(force for _, _, force in ticks) == 0)

    def expect_paused(self, player):
        player.change("Paused")
        self.expect_rest()

    def expect_ended(self, process, number=signal.SIGINT):
        """It ends by the signal; the test has a limit."""
        process.send_signal(number)
        self.assertEqual(process.wait(), 0, self.said())

    def plays(self, name, uri=None, kind=MockPlayer):
        player = kind(self.bus, name)
        player.change("Playing", uri=uri or self.film.as_uri(), position_s=2)
        return player

    def play(self, *words, name="mock", properties=(), least_N=FORCE_N, **variables):
        """A player that plays, and is felt."""
        player = self.plays(name)
        process = self.follow(*words, properties=properties, **variables)
        self.wait_until(lambda: process.poll() is not None or self.force_N() > least_N)
        self.assertIsNone(process.poll(), self.said())
        return player, process


class Follow(FollowCase):
    def test_position_pause_seek_and_rate_are_followed(self):
        player, process = self.play()
        self.assertIn("the haptic track", self.said())
        self.expect_found(player)
        self.expect_paused(player)
        player.change("Playing")
        self.expect_found(player)

        self.expect_followed_through_seeks(player)
        player.change("Paused")
        player.change(position_s=50)
        time.sleep(.5)
        player.change("Playing")
        self.expect_found(player)

        player.change(rate=1.5, position_s=10)
        self.expect_found(player)

        player.die()
        self.wait_until(lambda: "mock has ended" in self.said() and self.force_N() == 0)
        self.expect_ended(process)

    def expect_followed_through_seeks(self, player):
        for position_s in (30, 12):
            player.change(position_s=position_s)
            self.expect_found(player)

    def test_tracks_of_every_kind_are_followed(self):
        """As spidartrack records it, and inside the film."""
        flac = ("filesrc location=film.avi.haptic.wav ! wavparse ! audioconvert dithering=none noise-shaping=none ! flacenc "
                "blocksize=40 ! filesink location=film.avi.haptic.flac")
        inside = ("matroskamux name=m ! filesink location=film.mkv filesrc location=film.avi ! avidemux ! queue ! m. "
                  "filesrc location=film.avi.haptic.wav ! wavparse ! queue ! m.")
        self.gst(inside)
        self.gst(flac)
        self.path("film.avi.haptic.wav").unlink()
        for film, track in (("film.avi", "film.avi.haptic.flac"), ("film.mkv", "film.mkv")):
            with self.subTest(track):
                self.film = self.path(film)
                player, process = self.play(properties=["overlay=curve", "max-force=3"])
                self.assertIn(f"the haptic track {self.path(track)}", self.said())
                self.assertRegex(self.said(), "these have no effect: overlay\\n")
                self.expect_followed_through_seeks(player)
                self.expect_ended(process)
                player.die()
                self.trace.unlink()

    def test_a_script_beside_the_film_is_followed(self):
        """The picture stands still, so that only the script can be felt."""
        self.path("film.avi.haptic.wav").unlink()
        self.path("film.funscript").write_text(json.dumps({"actions": [{"at": 0, "pos": 0}, {"at": 60000, "pos": 0}]}))
        player, _ = self.play(least_N=1)
        self.assertIn(f"Felt instead of the film's motion: {self.path('film.funscript')}: fy, gain 3.3 taken back: "
                      "100 % is 3 N.\n", self.said())
        self.expect_paused(player)

    def test_rules_are_felt_before_the_track_of_the_film(self):
        """The picture stands still, so that only the track could be felt."""
        player = MockPlayer(self.bus, "mock")
        player.change("Playing", uri=self.film.as_uri(), position_s=2)
        self.follow(properties=["feel=largest"])
        self.wait_until(lambda: f"{self.film}.haptic.wav is not felt, because feel= says what is.\n" in self.said())
        self.assertNotIn("is felt", self.said())

    @track_case.needs("ffmpeg")
    def test_without_a_track_the_film_is_analysed(self):
        """Also by a decoder of ffmpeg: those for one kind of pictures are found more easily than those that also name interlaced
        ones."""
        self.path("film.avi.haptic.wav").unlink()
        for make in ("gst-launch-1.0 -q videotestsrc pattern=ball num-buffers=500 ! video/x-raw,width=160,height=120,framerate=25/1 ! "
                     "jpegenc ! avimux ! filesink location=film.avi",
                     "ffmpeg -nostdin -v error -y -f lavfi -i testsrc2=size=160x120:rate=25:duration=20 -c:v mpeg4 film.avi"):
            with self.subTest(make):
                self.run_in_folder(make)
                player, process = self.play(least_N=.1)
                self.assertIn("is analysed", self.said())
                self.expect_paused(player)
                self.expect_ended(process)
                player.die()
                self.trace.unlink()

    def test_a_track_of_another_film_is_named_and_not_felt(self):
        samples, _ = track_case.read_wav(self.path("film.avi.haptic.wav"))
        track_case.write_wav(self.path("film.avi.haptic.wav"), samples[:5000])
        player = MockPlayer(self.bus, "mock")
        player.change("Playing", uri=self.film.as_uri(), position_s=2)
        self.follow()
        self.wait_until(lambda: "is analysed" in self.said())
        self.assertRegex(self.said(), "film.avi.haptic.wav: .*; the film is analysed")

    def test_one_that_stands_still_is_at_rest(self):
        """It says that it plays."""
        player, _ = self.play()
        player.at_s, player.since_s, player.delay = player.position_s(), time.monotonic(), 1e6
        player.rate = 1e-9
        self.expect_rest()

    def test_what_no_player_should_tell_harms_nothing(self):
        player, process = self.play()
        for rate in (float("nan"), float("inf"), -1.0, 1e-300):
            player.told_rate = rate
            player.change()
            time.sleep(.1)
        for uri in ("file:///" + 1_000_000 * "x", self.film.as_uri()):
            player.change(uri=uri)
            time.sleep(.3)
        self.assertLess(len(self.said()), 100_000)
        for position_s in (-1e6, 9e12, -9e12, 1e6, 20):
            player.change(position_s=position_s)
            time.sleep(.3)
        self.assertIsNone(process.poll())
        self.expect_found(player)


class Which(FollowCase):
    def wait_for(self, sentence):
        self.wait_until(lambda: sentence + "\n" in self.said())

    def test_without_a_player_it_waits_and_takes_the_one_that_plays(self):
        process = self.follow()
        self.wait_for("waits for a player that plays a file: VLC, or mpv with the package mpv-mpris")
        paused = MockPlayer(self.bus, "paused")
        paused.change("Paused", uri=self.film.as_uri())
        self.wait_for("paused is paused in a film: follows paused")
        plays = self.plays("plays.instance12")
        self.wait_for("paused is paused, and plays plays: follows plays")
        plays.die()
        self.wait_for("plays has ended, and paused is paused in a film: follows paused")
        paused.change("Playing")
        self.wait_until(lambda: self.force_N() > FORCE_N)
        paused.die()
        self.wait_for("paused has ended; waits for a player that plays a film")
        self.assertIsNone(process.poll())

    def test_of_several_of_a_name_the_one_that_plays_is_felt(self):
        MockPlayer(self.bus, "vlc").change("Paused", uri=self.film.as_uri(), position_s=40)
        second = self.plays("vlc.instance7")
        self.follow("vlc")
        self.expect_found(second)

    def test_players_that_do_not_answer_hold_nothing_up(self):
        class Silent(MockPlayer):
            def get(self, *_):
                return threading.Event().wait()
        for number in range(30):
            Silent(self.bus, f"a{number:02}")
        _, process = self.play(name="z")
        self.assertEqual(self.said().count("follows z"), 1)
        self.expect_ended(process)

    def test_without_a_bus_it_ends(self):
        said = self.run_in_folder(f"DBUS_SESSION_BUS_ADDRESS=unix:path=/nowhere {FEEL} --follow", 1)
        self.assertIn("there is no session bus, by which players are followed", said)

    def test_a_bus_that_says_nothing_is_not_waited_for_for_ever(self):
        with socket.socket(socket.AF_UNIX) as silent:
            silent.bind(str(self.path("bus")))
            silent.listen()
            said = self.run_in_folder(f"DBUS_SESSION_BUS_ADDRESS=unix:path={self.path('bus')} {FEEL} --follow", 1)
        self.assertIn("there is no session bus, by which players are followed: it does not answer", said)


class WhatIsPlayed(FollowCase):
    def test_what_is_no_film_is_named_and_the_next_film_is_felt(self):
        self.gst("audiotestsrc num-buffers=50 ! flacenc ! filesink location=song.flac")
        self.gst("videotestsrc num-buffers=1 ! jpegenc ! filesink location=cover.jpg")
        os.mkfifo(self.path("pipe.avi"))
        player = self.plays("mock", self.path("song.flac").as_uri())
        process, sentences = self.follow("mock"), []
        for name, sentence in (
                ("song.flac", "there are no pictures in it; without force until the next film"),
                ("cover.jpg", "it is a single picture, in which nothing moves;"),
                ("nothing.avi", "there is no such file; without force until the next"),
                ("pipe.avi", "it is not a regular file;"),  # and is not opened
                ("testbin://", "only files of this machine, http and https are followed;")):
            with self.subTest(name):
                uri = name if ":" in name else self.path(name).as_uri()
                sentences.append(f"mock plays {name if ':' in name else self.path(name)}: {sentence}")
                player.change(uri=uri, position_s=2)
                self.wait_until(lambda: sentences[-1] in self.said())
                for wrong in ("is analysed", "is felt", "plug-in"):
                    self.assertNotIn(wrong, self.said())
        player.change(uri=self.film.as_uri(), position_s=2)
        self.wait_until(lambda: self.force_N() > FORCE_N)
        self.assertEqual([self.said().count(sentence) for sentence in sentences], 5 * [1], self.said())
        self.expect_ended(process, signal.SIGTERM)

    def test_the_stream_that_players_show_is_felt_and_not_a_cover(self):
        self.path("film.avi.haptic.wav").unlink()
        self.gst("videotestsrc num-buffers=1 ! video/x-raw,width=200,height=300 ! jpegenc ! m. videotestsrc pattern=ball "
                 "num-buffers=500 ! video/x-raw,width=160,height=120,framerate=25/1 ! theoraenc ! m. "
                 "matroskamux name=m ! filesink location=film.mkv")
        self.plays("mock", self.path("film.mkv").as_uri())
        self.follow()
        self.wait_until(lambda: self.force_N() > .1)

    def test_what_another_program_tells_is_shown_in_short_and_harmlessly(self):
        # What is longer than 64 KiB counts as no address.
        self.plays("mock", "\033]0;title\007" + "x" * 60_000)
        self.follow("mock")
        self.wait_until(lambda: "are followed" in self.said())
        self.assertLess(len(self.said()), 5000)
        self.assertNotIn("\033", self.said())

    def test_an_address_that_is_not_escaped_names_its_file(self):
        for name in ("50% of #3.avi", "a%20b.avi"):
            with self.subTest(name=name):
                for end in (".avi", ".avi.haptic.wav"):
                    shutil.copy(self.path("film" + end), self.path(name[:-4] + end))
                player = self.plays("mock", "file://" + str(self.path(name)))
                process = self.follow()
                self.wait_until(lambda: self.force_N() > FORCE_N)
                self.assertIn(f"the haptic track {self.path(name)}.haptic.wav is felt\n", self.said())
                self.expect_ended(process)
                player.die()
                self.trace.unlink()


class WhereItIs(FollowCase):
    def test_a_player_that_does_not_tell_where_it_goes_is_named_once_and_nothing_is_felt(self):
        class Lost(MockPlayer):
            interface = interface(has_position=False)
        begin_s = time.monotonic()
        for kind, position_s, sentence in (
                (Lost, MockPlayer.position_s, "mock does not tell where it is in its film, so nothing of it is felt;"),
                (MockPlayer, lambda *_: 0.0, "mock says that it plays, and that it stands at 0.0 s, so nothing of it is felt;"),
                (MockPlayer, lambda *_: 1e4 - (time.monotonic() - begin_s), "mock plays backwards, which is not felt")):
            with self.subTest(sentence), unittest.mock.patch.object(MockPlayer, "position_s", position_s):
                player = self.plays("mock", kind=kind)
                process = self.follow()
                self.wait_until(lambda: sentence in self.said())
                self.assertNotIn("is felt\n", self.said())
                time.sleep(1)
                self.assertEqual(self.said().count(sentence), 1, self.said())
                self.assertEqual(self.force_N(), 0)
                player.die()
                self.expect_ended(process)


class Seen(FollowCase):
    def setUp(self):
        super().setUp()
        self.window = self.path("window.sh")
        self.window.write_text(f"#!/bin/sh\ntouch {self.path('opened')}\nexec cat >/dev/null\n", encoding="ascii")
        self.window.chmod(0o755)
        self.screen = {"DISPLAY": ":7", "SPIDAR_WINDOW": str(self.window)}

    def test_without_a_device_the_window_opens(self):
        self.play(**self.screen)
        self.wait_until(self.path("opened").exists)

    def test_debug_window_false_prevents_it(self):
        self.play(properties=["debug-window=false"], **self.screen)
        time.sleep(.5)
        self.assertFalse(self.path("opened").exists())


# What a player without a list of tracks names (MPRIS); it ignores SetPosition, which is for a track of that list.
NO_TRACK = "/org/mpris/MediaPlayer2/TrackList/NoTrack"


class Obedient(MockPlayer):
    """Does what it is asked to."""

    def __init__(self, bus, name):
        self.track, self.can = "/film/1", True
        self.asked = []
        super().__init__(bus, name)

    def get(self, _connection, _sender, _path, _interface, name):
        value = super().get(_connection, _sender, _path, _interface, name)
        if name != "Metadata" or not self.track:
            return value
        return GLib.Variant("a{sv}", {"xesam:url": GLib.Variant("s", self.uri),
                                      "mpris:trackid": GLib.Variant("o", self.track)})

    def called(self, _connection, _sender, _path, _interface, method, parameters, invocation):
        self.asked.append((method, *parameters.unpack()))
        if not self.can:
            return invocation.return_dbus_error("org.mpris.Error", "no")
        invocation.return_value(None)
        if method == "PlayPause":
            self.change("Paused" if self.status == "Playing" else "Playing")
        elif method == "SetPosition" and parameters.unpack()[0] == self.track != NO_TRACK:
            self.change(position_s=1e-6 * parameters.unpack()[1])
        elif method == "Seek":
            self.change(position_s=self.position_s() + 1e-6 * parameters.unpack()[0])


@unittest.skipUnless(os.path.exists(os.path.join(os.path.dirname(FEEL), "spidar-window")), "spidar-window is not built")
class Controlled(screen.ScreenCase, FollowCase):
    def press_p(self):
        screen.xdotool("windowfocus", "--sync", self.window, "key", "p")
        time.sleep(.5)  # until the window shows what has come of it, usually

    def click_on_timeline(self):
        """In the middle of the window, on the film (model/layout.cpp, timeline_panel.cpp)."""
        y = self.size[1] * (1 - .23) - 34 - 4 - 12.5
        for step in (("mousemove", "--window", self.window, self.size[0] // 2, round(y)), ("mousedown", 1), ("mouseup", 1)):
            screen.xdotool(*step)
            time.sleep(.3)  # some pictures of the window

    def test_pause_and_a_click_on_the_timeline_go_to_the_player(self):
        player = self.plays("mock", kind=Obedient)
        self.follow(properties=["debug-window=true"], DISPLAY=os.environ["DISPLAY"])
        self.wait_until(screen.windows)
        self.window = screen.windows()[-1]
        shape = dict(line.split("=") for line in screen.xdotool("getwindowgeometry", "--shell", self.window).split())
        self.size = int(shape["WIDTH"]), int(shape["HEIGHT"])
        self.expect_found(player)
        for status in ("Paused", "Playing"):
            while player.status != status:
                self.press_p()
        self.assertEqual(set(player.asked), {("PlayPause",)})
        for player.track, method in (("", "Seek"), ("/film/1", "SetPosition"), (NO_TRACK, "Seek")):
            player.change(position_s=2)
            while player.asked[-1][0] != method:  # a window on a busy machine may not see a click
                self.click_on_timeline()
            self.assertGreater(player.position_s(), LENGTH_S / 3)  # the film begins at the left
            self.expect_found(player)
            player.change(position_s=2)
            self.expect_found(player)
        player.can = False
        while "mock does not let other programs control it" not in self.said():
            self.press_p()


if __name__ == "__main__":
    unittest.main()
