# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidar-feel --screen with plain windows on a screen that nobody sees."""

import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst

import bus_case
import screen
import track_case
from bus_case import FEEL
from mpris_player import Bus
from screen_portal import CANCELLED, FAILED, PipeWire, Portal
from screen import comes, xdotool

HERE = pathlib.Path(__file__).parent
BALL = "videotestsrc is-live=true pattern=ball ! video/x-raw,width=320,height=240,framerate=25/1"
RESTING = "videotestsrc is-live=true pattern=smpte ! video/x-raw,width=320,height=240,framerate=25/1"
FRAMES = tempfile.TemporaryDirectory(prefix="spidar-film-")
# It is felt even where a busy machine shows only two of its frames a second, see setUpModule().
FILM = f"multifilesrc location={FRAMES.name}/%d.jpg stop-index=499 loop=true caps=image/jpeg,framerate=25/1 ! jpegdec"


def setUpModule():
    """Everything in the picture of the film moves, in another way than the patch in it: by a pixel or two from one frame to
    the next, and by not much more where a busy machine shows only some of them."""
    unittest.addModuleCleanup(FRAMES.cleanup)
    turn = "2*PI*t/20"
    for command in (
            "ffmpeg -v error -f lavfi -i color=gray:s=800x480:d=1,noise=alls=100,gblur=2 -frames:v 1 texture.png",
            f"ffmpeg -v error -loop 1 -i texture.png -filter_complex '[0]split[a][b];[a]crop=320:240:240+100*sin({turn}):100"
            f"[far];[b]crop=80:80:0:0[near];[far][near]overlay=120+80*sin(2*{turn}):80+40*cos(2*{turn})' -r 25 -t 20 "
            "-q:v 3 -start_number 0 %d.jpg"):
        subprocess.run(command, shell=True, cwd=FRAMES.name, stdin=subprocess.DEVNULL, check=True)


class LookedAtCase(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.trace, self.log = self.path("trace.csv"), self.path("log")

    def look(self, what="", *properties, **variables):
        with open(self.log, "w", encoding="utf-8") as log:
            process = subprocess.Popen([FEEL, "device=sim", "debug-window=false", f"haptic-trace={self.trace}", *properties,
                                        "--screen" + what], stdout=log, stderr=log, cwd=self.folder,
                                       env=os.environ | {"WAYLAND_DISPLAY": ""} | variables)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def said(self):
        return self.log.read_text(encoding="utf-8")

    def expect_said(self, text):
        self.assertTrue(comes(lambda: text in self.said()), self.said())

    def rows(self):
        """Of the haptic trace, whose last one may still be written."""
        with open(self.trace, newline="", encoding="ascii") as file:
            return list(csv.DictReader(file.read().rpartition("\n")[0].splitlines()))

    def largest_N(self, newest_s):
        ticks = bus_case.read_trace(self.trace)
        return bus_case.largest_N([tick for tick in ticks if tick[0] > ticks[-1][0] - newest_s])

    def expect_felt(self):
        self.assertTrue(comes(lambda: self.largest_N(.2) > .1), "nothing is felt: " + self.said())

    def expect_rest(self):
        """For half a second."""
        self.assertTrue(comes(lambda: bus_case.read_trace(self.trace) and self.largest_N(.5) == 0), "it does not rest")


class Windows(screen.ScreenCase, LookedAtCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        Gst.init(None)
        if not Gst.ElementFactory.find("ximagesrc"):
            raise unittest.SkipTest("ximagesrc, which reads the screen, is not installed")

    def expect_no_picture(self):
        """For half a second, nor an old one: several of those in turn would be felt as motion."""
        def found():
            rows = self.rows()
            return {row["found"] for row in rows if int(row["monotonic_ns"]) > int(rows[-1]["monotonic_ns"]) - 5e8}
        self.assertTrue(comes(lambda: found() == {"expired"}), "pictures come")
        self.expect_rest()

    def show(self, title, line=FILM, at=(0, 0)):
        """A window with a moving picture, at this position."""
        before = screen.windows()
        process = subprocess.Popen([sys.executable, HERE / "screen_film.py", title, line])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.assertTrue(comes(lambda: len(screen.windows()) > len(before)), "no window comes")
        process.window = next(window for window in screen.windows() if window not in before)
        xdotool("windowmove", "--sync", process.window, *at)
        return process

    def test_a_window_is_chosen_by_its_title_and_felt_while_it_can_be_seen(self):
        self.show("Resting", RESTING)
        film = self.show("A ball – Player", at=(400, 100))
        felt = self.look("=a ball")
        self.expect_said('looks at the window "A ball – Player"')
        self.expect_felt()
        xdotool("windowmove", film.window, 1200, 100)
        self.expect_said("reaches beyond the edge of the screen")
        self.expect_no_picture()
        xdotool("windowmove", film.window, 500, 300)
        self.expect_said('the window "A ball – Player" can be seen again')
        self.expect_felt()
        xdotool("windowsize", film.window, 400, 300)
        cover = self.show("Cover", RESTING, at=(480, 280))
        xdotool("windowsize", cover.window, 500, 400)
        self.expect_said("is covered by another one")
        self.expect_rest()
        xdotool("windowmove", cover.window, 700, 280)
        self.expect_said("is covered in part")
        # A menu or a bubble, such as a browser's advice to press Esc, goes by itself.
        before = self.said().count("can be seen again")
        xdotool("set_window", "--overrideredirect", 1, cover.window)
        self.assertTrue(comes(lambda: self.said().count("can be seen again") > before), self.said())
        xdotool("set_window", "--overrideredirect", 0, cover.window)
        xdotool("windowunmap", film.window)
        self.expect_said("is minimised")
        self.expect_no_picture()
        xdotool("windowmap", film.window, "windowraise", film.window)
        self.expect_felt()
        film.kill()
        self.expect_said("is closed")
        self.assertEqual(felt.wait(), 0)
        ticks = bus_case.read_trace(self.trace)
        self.assertEqual(ticks[-1][2], 0)

    def test_a_window_is_chosen_by_a_click_and_the_background_is_the_whole_screen(self):
        self.show("Somewhere", at=(400, 100))
        for at, what in (((500, 200), 'the window "Somewhere"'), ((1000, 700), "the whole screen")):
            felt = self.look("=ask")
            self.expect_said("click on the window")
            xdotool("mousemove", *at)
            # Until the mouse is taken, a click goes to the window.
            self.assertTrue(comes(lambda: xdotool("click", 1) or "looks at" in self.said()), self.said())
            self.expect_said("looks at " + what)
            self.expect_felt()
            felt.send_signal(signal.SIGINT)
            self.assertEqual(felt.wait(), 0)
        felt = self.look("=ask")
        self.assertTrue(comes(lambda: xdotool("click", 3) or felt.poll() is not None))
        self.assertEqual(felt.wait(), 1)
        self.expect_said("no window was clicked on with the left button")

    def test_a_title_that_no_window_has_is_answered_by_those_there_are(self):
        self.show("One")
        self.assertEqual(self.look("=Two").wait(), 1)
        self.expect_said('no window is called "Two"; there are "One"')

    def test_properties_that_are_set_to_something_else_are_left_alone(self):
        """By any program: a list of windows in items of 8 bits, and a title that is no UTF-8."""
        film = self.show("Film")
        screen.set_property(film.window, "_NET_WM_NAME", "UTF8_STRING", 8, "A ball \u00e9\0 and more".encode("latin-1"))
        for bits in (8, 16):
            screen.set_property(None, "_NET_CLIENT_LIST_STACKING", "WINDOW", bits, bytes(range(1, 9)))
            self.assertEqual(self.look("=Two").wait(), 1)
            self.expect_said('no window is called "Two"; there are "A ball \u00e9"')

    def test_the_film_is_found_among_what_moves_and_rests(self):
        self.show("Ball", BALL, at=(800, 500))
        self.show("Page", RESTING, at=(0, 400))
        self.show("Film", at=(400, 100))
        self.look()
        self.expect_said("a film is in it, 320 x 240 at 400, 100")
        self.expect_felt()

    @unittest.skipUnless(pathlib.Path(FEEL).with_name("spidar-window").exists(), "it was built without the debug window")
    def test_the_debug_window_is_left_out(self):
        felt = self.look("", "debug-window=true")
        self.expect_said("looks at the whole screen")
        self.assertTrue(comes(screen.windows), self.said())
        self.expect_said("All frames of the last second show the same picture.")
        felt.kill()

    @unittest.skipUnless(pathlib.Path(FEEL).with_name("spidar-window").exists(), "it was built without the debug window")
    def test_the_debug_window_goes_out_of_the_way(self):
        """Without a window manager, it opens at the upper left, over what is there."""
        film = self.show("Film")
        self.look("", "debug-window=true")
        self.assertTrue(comes(lambda: len(screen.windows()) > 1), self.said())
        own = next(window for window in screen.windows() if window != film.window)
        def left_and_top():
            lines = dict(line.split("=") for line in xdotool("getwindowgeometry", "--shell", own).splitlines())
            return int(lines["X"]), int(lines["Y"])
        self.assertTrue(comes(lambda: left_and_top() > (320, 240)), left_and_top())
        self.expect_felt()

    def test_own_windows_are_left_out(self):
        """A film in a window of this class is black. It says why nothing is felt."""
        film = self.show("Own", at=(100, 100))
        xdotool("set_window", "--class", "spidar-window", film.window)
        felt = self.look()
        self.expect_said("All frames of the last second show the same picture.")
        self.expect_rest()
        xdotool("set_window", "--class", "another", film.window)
        self.expect_felt()
        felt.kill()

    def test_without_a_screen_it_says_so(self):
        for variables, said in (({"DISPLAY": ""}, "neither WAYLAND_DISPLAY nor DISPLAY is set"),
                                ({"DISPLAY": ":9999"}, "the screen :9999 cannot be opened")):
            self.assertEqual(self.look(**variables).wait(), 1)
            self.expect_said(said)


class End(screen.ScreenCase, LookedAtCase):
    def test_it_ends_with_the_screen(self):
        felt = self.look()
        self.expect_said("looks at the whole screen")
        self.screen.stop()
        self.assertEqual(felt.wait(), 1)
        self.expect_said("the screen has ended")


@unittest.skipUnless(Bus.is_there(), "dbus-daemon is not installed (package dbus-daemon)")
class Wayland(LookedAtCase):
    def setUp(self):
        super().setUp()
        self.bus = Bus()
        self.addCleanup(self.bus.stop)
        self.state = self.path("state")

    def look(self, what="", *properties, **variables):
        return super().look(what, *properties, **{"WAYLAND_DISPLAY": "wayland-9", "XDG_STATE_HOME": str(self.state),
                                                  "DBUS_SESSION_BUS_ADDRESS": self.bus.address} | variables)

    def portal(self, *arguments, **options):
        portal = Portal(self.bus, *arguments, **options)
        self.addCleanup(portal.stop)
        return portal

    def pipewire(self):
        if why := PipeWire.why_not():
            self.skipTest(why)
        pipewire = PipeWire(self.folder, self.bus)
        self.addCleanup(pipewire.stop)
        return pipewire

    def test_without_its_portal_the_sharing_goes_on_and_without_pipewire_it_ends(self):
        pipewire = self.pipewire()
        portal = self.portal(pipewire.socket, pipewire.share(BALL.replace("raw,", "raw,format=BGRx,")))
        felt = self.look()
        self.expect_felt()
        portal.stop()
        gone_s = bus_case.read_trace(self.trace)[-1][0]
        self.assertTrue(comes(lambda: bus_case.largest_N([tick for tick in bus_case.read_trace(self.trace)
                                                          if tick[0] > gone_s + .5]) > .1), self.said())
        pipewire.stop()
        self.expect_said("PipeWire has ended")
        self.assertEqual(felt.wait(), 0)
        self.assertEqual(bus_case.read_trace(self.trace)[-1][2], 0)

    def test_what_the_desktop_shares_is_felt_and_it_is_asked_again_only_on_demand(self):
        pipewire = self.pipewire()
        portal = self.portal(pipewire.socket)
        for what, token in (("", None), ("", "token 1"), ("=ask", None)):
            with self.subTest(what, token=token):
                self.trace.unlink(missing_ok=True)
                portal.node = pipewire.share(BALL.replace("raw,", "raw,format=BGRx,"))
                felt = self.look(what)
                self.expect_said("looks at the window that the desktop shares")
                self.expect_felt()
                options = portal.selected[-1]
                self.assertEqual((options["types"], options["persist_mode"], options.get("restore_token")), (3, 2, token))
                # The mouse is hidden, which is what the portal does by itself.
                self.assertNotIn("cursor_mode", options)
                portal.end_sharing()
                self.expect_said("the desktop has ended the sharing")
                self.assertEqual(felt.wait(), 0)
                self.assertEqual(bus_case.read_trace(self.trace)[-1][2], 0)

    def test_with_a_token_that_is_void_it_is_asked_anew(self):
        portal = self.portal()
        (self.state / "gst-spidar").mkdir(parents=True)
        (self.state / "gst-spidar" / "screen-token").write_text("void")
        for portal.void in ("SelectSources", "response"):
            self.assertEqual(self.look().wait(), 1)
            self.expect_said("the desktop's portal fails in OpenPipeWireRemote")  # it has allowed the rest
            self.assertEqual([each.get("restore_token") for each in portal.selected[-2:]], ["void", None])

    def test_a_portal_that_lies_is_refused(self):
        def answer(**results):
            return GLib.Variant("(ua{sv})", (0, results))
        text, number = GLib.Variant("s", "no path"), GLib.Variant("u", 7)
        portal = self.portal()
        for lies, said in (({"CreateSession": GLib.Variant("(us)", (0, "x"))}, "could not share the screen"),
                           ({"CreateSession": answer(session_handle=text)}, "names no session"),
                           ({"CreateSession": answer(session_handle=number)}, "names no session"),
                           ({"CreateSession": answer()}, "names no session"),
                           ({"Start": answer(streams=text, restore_token=number)}, "the desktop shares nothing"),
                           ({"Start": answer(streams=GLib.Variant("a(ua{sv})", []))}, "the desktop shares nothing")):
            with self.subTest(lies):
                portal.lies = lies
                self.assertEqual(self.look().wait(), 1)
                self.expect_said(said)

    def test_what_is_missing_is_said(self):
        def expect_refused(said, what="", **variables):
            self.assertEqual(self.look(what, **variables).wait(), 1)
            self.expect_said(said)
        expect_refused("there is no session bus", DBUS_SESSION_BUS_ADDRESS="unix:path=/nowhere")
        expect_refused("this desktop has no portal that shares its screen")
        portal = self.portal()
        expect_refused("programs do not know the titles of windows", "=Firefox")
        expect_refused("the desktop's portal fails in OpenPipeWireRemote")
        for portal.status, said in ((CANCELLED, "the desktop was not allowed to share its screen"),
                                    (FAILED, "the desktop's portal could not share the screen")):
            expect_refused(said)


if __name__ == "__main__":
    unittest.main()
