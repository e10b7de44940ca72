# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel --follow with mpv and VLC, on a screen that nobody sees. Each picture of the film has its number in black and
white, and its haptic track is a force that rises with the position: so both what is seen and what is felt tell where they
are. Players that are not installed are skipped."""

import csv
import os
import shutil
import statistics
import subprocess
import time
import unittest

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gio, GLib, Gst

import bus_case
import screen
import test_follow
from mpris_player import PATH, PLAYER, Bus

WIDTH, HEIGHT, RATE_HZ, BITS, BIT_PX, BAR_PX = 320, 240, 25, 12, 20, 24
RAMP_S = .1  # to rest
MEDIAN_S, MOST_S = .015, .04  # the goal of docs/players.md
# Sessions refuse other users by default, and VLC refuses root.
FOR_ALL = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd"><busconfig>
<include>/usr/share/dbus-1/session.conf</include><policy context="default"><allow user="*"/></policy></busconfig>"""


def picture(number):
    """Grey, with a white square, a black one, and the bits of the number from the lowest on."""
    bits = [1, 0] + [number >> bit & 1 for bit in range(BITS)]
    row = b"".join(bytes([235 if bit else 16]) * BIT_PX for bit in bits).ljust(WIDTH, b"\x10")
    return row * BAR_PX + b"\x80" * (WIDTH * (HEIGHT - BAR_PX) + WIDTH * HEIGHT // 2)


def number_in(row):
    """The number in a row of BGRx, if there is one."""
    bits = [row[4 * (BIT_PX * at + BIT_PX // 2) + 1] > 128 for at in range(BITS + 2)]
    return sum(bit << at for at, bit in enumerate(bits[2:])) if bits[0] and not bits[1] else None


class Watched:
    """When each picture was first on the screen: (monotonic s, position in the film, s)."""

    def __init__(self, at=(0, 0)):
        """`at`: where on the screen the film is."""
        self.seen = []
        self.pipeline = Gst.parse_launch(
            f"ximagesrc show-pointer=false use-damage=false startx={at[0]} starty={at[1]} endx={at[0] + WIDTH - 1} "
            f"endy={at[1] + BAR_PX - 1} ! video/x-raw,framerate=200/1 ! "
            "appsink name=out emit-signals=true sync=false max-buffers=1 drop=true")
        self.pipeline.get_by_name("out").connect("new-sample", self.take)
        self.pipeline.set_state(Gst.State.PLAYING)

    def take(self, sink):
        frame = sink.emit("pull-sample").get_buffer()
        now_s = time.monotonic()
        number = number_in(frame.extract_dup(WIDTH * 4 * (BAR_PX // 2), WIDTH * 4))
        if number is not None and (not self.seen or self.seen[-1][1] != number / RATE_HZ):
            self.seen.append((now_s, number / RATE_HZ))
        return Gst.FlowReturn.OK

    def stop(self):
        self.pipeline.set_state(Gst.State.NULL)


class Real:
    """What each test of a player does; its class says which one."""
    COMMAND = ()
    NAME = ""

    def setUp(self):
        for program in (self.COMMAND[0], "ffmpeg", "dbus-daemon"):
            if not shutil.which(program):
                self.skipTest(f"{program} is not installed")
        Gst.init(None)
        if not Gst.ElementFactory.find("ximagesrc"):
            self.skipTest("ximagesrc, which reads the screen, is not installed")
        super().setUp()
        self.folder.chmod(0o755)
        self.path("home").mkdir()
        self.path("home").chmod(0o777)
        self.path("bus.conf").write_text(FOR_ALL, encoding="ascii")
        self.bus = Bus(f"--config-file={self.path('bus.conf')}")
        self.addCleanup(self.bus.stop)
        flags = Gio.DBusConnectionFlags.AUTHENTICATION_CLIENT | Gio.DBusConnectionFlags.MESSAGE_BUS_CONNECTION
        self.connection = Gio.DBusConnection.new_for_address_sync(self.bus.address, flags)
        self.film, self.trace, self.log = (self.path(name) for name in ("film.mkv", "trace.csv", "log"))
        self.make_film()
        test_follow.write_track(self.path("film.mkv.haptic.wav"))
        self.watched = Watched()
        self.addCleanup(self.watched.stop)

    def make_film(self):
        command = (f"ffmpeg -v error -f rawvideo -pix_fmt yuv420p -s {WIDTH}x{HEIGHT} -r {RATE_HZ} -i - -f lavfi -i "
                   "sine=frequency=300 -shortest -c:v mjpeg -q:v 2 -c:a libvorbis film.mkv")
        with subprocess.Popen(command.split(), cwd=self.folder, stdin=subprocess.PIPE) as encoder:
            for number in range(RATE_HZ * test_follow.LENGTH_S):
                encoder.stdin.write(picture(number))
            encoder.stdin.close()

    def start_player(self):
        """As somebody else, where root may not play."""
        env = dict(os.environ, HOME=str(self.path("home")), XDG_RUNTIME_DIR=str(self.path("home")),
                   DBUS_SESSION_BUS_ADDRESS=self.bus.address)
        env.pop("LD_PRELOAD", None)
        other = ["setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups"] if os.geteuid() == 0 else []
        player = subprocess.Popen([*other, *self.COMMAND, self.film], cwd=self.folder, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL, env=env)
        self.addCleanup(player.wait)
        self.addCleanup(player.kill)
        return player

    def call(self, method, arguments=None):
        names = self.connection.call_sync("org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus",
                                          "ListNames", None, None, 0, -1).unpack()[0]
        name = next(name for name in names if name.startswith("org.mpris.MediaPlayer2." + self.NAME))
        return self.connection.call_sync(name, PATH, PLAYER, method, arguments, None, 0, -1)

    def lags_s(self, felt, from_s, to_s):
        """What is felt later than what is seen, while both are there. `felt`: (monotonic s, position s)."""
        lags, at = [], 0
        for now_s, position_s in self.watched.seen:
            while at < len(felt) and felt[at][0] < now_s:
                at += 1
            if from_s <= now_s <= to_s and at < len(felt):
                lags.append(position_s - felt[at][1])
        return lags

    def ticks(self, from_s, to_s):
        """(monotonic s, N) of what the trace has between two times, when it has it."""
        self.wait_until(lambda: any(tick[0] > to_s for tick in bus_case.read_trace(self.trace)))
        return [(now_s, force) for now_s, _, force, _ in bus_case.read_trace(self.trace) if from_s <= now_s <= to_s]

    def felt_of_track(self, from_s, to_s):
        return [(now_s, test_follow.felt_position_s(force)) for now_s, force in self.ticks(from_s, to_s)]

    def felt_of_film(self, from_s, to_s):
        """By the running time of the loop, and by that of a frame, from the newest seek on."""
        with open(self.path("frames.csv"), newline="", encoding="ascii") as file:
            whole = file.read().rpartition("\n")[0].splitlines()
        newest = list(csv.DictReader(whole))[-1]
        later_s = 1e-9 * (int(newest["stream_time_ns"]) - int(newest["running_time_ns"]))
        self.ticks(from_s, to_s)  # until they are there
        return [(now_s, running_s + later_s) for now_s, running_s, _, playing in bus_case.read_trace(self.trace)
                if playing and from_s <= now_s <= to_s]

    def expect_in_time(self, from_s, to_s, when, felt=None):
        lags = self.lags_s((felt or self.felt_of_track)(from_s, to_s), from_s, to_s)
        sizes = sorted(map(abs, lags))
        self.assertGreater(len(sizes), .5 * RATE_HZ * (to_s - from_s), "too few pictures were seen")
        median_s, most_s = statistics.median(sizes), sizes[int(.95 * len(sizes))]
        print(f"{self.NAME}, {when}: {1e3 * statistics.median(lags):+.1f} ms in the median, 95 % within {1e3 * most_s:.1f} ms, "
              f"{len(lags)} pictures", flush=True)
        self.assertLess(median_s, MEDIAN_S)
        self.assertLess(most_s, MOST_S)

    def test_what_is_felt_is_what_is_seen(self):
        player = self.start_player()
        self.follow()
        self.wait_until(lambda: self.force_N() > test_follow.FORCE_N)
        begin_s = time.monotonic() + .5
        time.sleep(15)
        self.expect_in_time(begin_s, time.monotonic() - .1, "steady")
        for by_s in (10, -15):
            self.call("Seek", GLib.Variant("(x)", (int(1e6 * by_s),)))
            sought_s = time.monotonic()
            time.sleep(3)
            self.expect_in_time(sought_s + .5, time.monotonic() - .1, f"from .5 s after a seek by {by_s} s")
        self.call("Pause")
        paused_s = time.monotonic()
        time.sleep(1)
        self.assertEqual(max(force for _, force in self.ticks(paused_s + .25, time.monotonic())), 0)
        self.call("Play")
        played_s = time.monotonic()
        time.sleep(3)
        self.expect_in_time(played_s + .5, time.monotonic() - .1, "from .5 s after a pause")
        player.kill()
        died_s = time.monotonic()
        time.sleep(.5)
        self.wait_until(lambda: "has ended" in self.said())
        self.assertEqual([force for now_s, _, force, _ in bus_case.read_trace(self.trace)
                          if now_s > died_s + RAMP_S and force], [])

    def test_a_film_that_is_analysed_is_in_time(self):
        self.path("film.mkv.haptic.wav").unlink()
        self.start_player()
        self.follow(properties=[f"trace={self.path('frames.csv')}"])
        self.wait_until(lambda: any(playing for _, _, _, playing in bus_case.read_trace(self.trace)))
        for by_s in (0, 20):
            self.call("Seek", GLib.Variant("(x)", (int(1e6 * by_s),)))
            begin_s = time.monotonic() + .5
            time.sleep(5)
            self.expect_in_time(begin_s, time.monotonic() - .1, f"analysed, after a seek by {by_s} s", self.felt_of_film)


class Mpv(Real, screen.ScreenCase, test_follow.FollowCase):
    COMMAND = ("mpv", "--vo=x11", "--ao=null", f"--geometry={WIDTH}x{HEIGHT}+0+0", "--no-border", "--no-osc", "--osd-level=0")
    NAME = "mpv"


class Vlc(Real, screen.ScreenCase, test_follow.FollowCase):
    COMMAND = ("vlc", "--intf=dummy", "--extraintf=dbus", "--no-video-deco", "--no-video-title-show", "--no-osd",
               "--vout=xcb_x11", "--aout=adummy", "--video-x=0", "--video-y=0")
    NAME = "vlc"


if __name__ == "__main__":
    unittest.main()
