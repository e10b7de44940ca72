# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The players of desktops under spidar-feel, on a screen that nobody sees, with an SH4 board on an emulated USB. Those that
need a session find one of their own, with a home in a temporary folder. Players that are not installed are skipped."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import bus_case
import screen
from bus_case import bus
from screen import comes

HERE = pathlib.Path(__file__).parent
IN_SESSION = "SPIDAR_TEST_IN_SESSION"
RAMP_TICKS = 60
MAX_ERRORS = 20  # HapticLoop::kMaxErrors: so many ticks may keep a force that the device has not answered


def run_in_session():
    """Runs this program again in a D-Bus session of its own, without what would make strangers' warnings fatal."""
    with tempfile.TemporaryDirectory() as folder:
        home, run = (os.path.join(folder, name) for name in ("home", "run"))
        settings = os.path.join(home, ".config/glib-2.0/settings")
        os.makedirs(settings)
        os.mkdir(run, 0o700)
        # GNOME Web would ask whether to become the default browser, and its dialog would take the keyboard.
        with open(os.path.join(settings, "keyfile"), "w", encoding="ascii") as file:
            file.write("[org/gnome/epiphany]\nask-for-default=false\n")
        left_out = {"XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "DBUS_SESSION_BUS_ADDRESS",
                    "G_DEBUG"}
        env = {name: value for name, value in os.environ.items() if name not in left_out}
        # Reading aloud would need a bus of its own.
        env.update({IN_SESSION: "1", "HOME": home, "XDG_RUNTIME_DIR": run, "GSETTINGS_BACKEND": "keyfile",
                    "LIBGL_ALWAYS_SOFTWARE": "1", "NO_AT_BRIDGE": "1", "GTK_A11Y": "none"})
        session = ["dbus-run-session", "--"] if shutil.which("dbus-run-session") else []
        sys.exit(subprocess.run([*session, sys.executable, *sys.argv], env=env, check=False).returncode)


def processes_with(library):
    """Those on this bus that have loaded it."""
    on_bus = f"SPIDAR_EMULATED_BUS={os.environ['SPIDAR_EMULATED_BUS']}".encode()
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if on_bus in (process / "environ").read_bytes() and library in (process / "maps").read_text():
                found.append(process.name)
        except OSError:  # it has ended
            pass
    return found


def press(key):
    """In the newest window. There is no window manager that would give it the keyboard."""
    screen.xdotool("windowfocus", screen.windows()[-1], "sleep", .2, "key", key)


class PlayerCase(screen.ScreenCase, bus_case.BusCase):
    def setUp(self):
        super().setUp()
        # 40 s of a ball.
        self.film, self.page, self.picture = (self.path(name) for name in ("film.webm", "page.html", "picture.png"))
        self.gst("videotestsrc pattern=ball num-buffers=1000 ! video/x-raw,width=160,height=120,"
                 "framerate=25/1 ! vp8enc deadline=1 cpu-used=16 keyframe-max-dist=25 ! webmmux ! filesink location=film.webm")
        self.page.write_text("<video id=v src=film.webm autoplay muted loop width=320></video><script>onkeydown = e => { "
                             "e.preventDefault(); v.paused ? v.play() : v.pause() }</script>")
        bus.bus_plug(0, b"sh4")

    def start(self, command, env=None):
        player = subprocess.Popen(command, cwd=self.folder, env=dict(os.environ, **(env or {})))
        self.addCleanup(player.wait)
        self.addCleanup(player.kill)
        return player


class Player:
    """What each test of a player does; its class says which one."""
    COMMAND = ()
    CHECK = ()       # says why it cannot run, and exits with another status than 0
    ENV = {}
    TOGGLE = "space"  # a key; None: SIGUSR1
    QUIT = "ctrl+q"   # a key, or a command; None: SIGUSR2
    NEEDS_SESSION = True

    def setUp(self):
        if not shutil.which(self.COMMAND[0]):
            self.skipTest(f"{self.COMMAND[0]} is not installed")
        if self.NEEDS_SESSION and "DBUS_SESSION_BUS_ADDRESS" not in os.environ:
            self.skipTest("dbus-run-session is not installed (package dbus-daemon)")
        super().setUp()
        if self.CHECK:
            said = self.run_in_folder(self.CHECK, None)
            if self.status:
                self.skipTest(said)
        self.ends = threading.Event()
        hand = threading.Thread(target=self.tremble)
        hand.start()
        self.addCleanup(hand.join)
        self.addCleanup(self.ends.set)

    def tremble(self):
        """A hand: counters that never move while the force changes are known to be broken."""
        by = 1
        while not self.ends.wait(.005):
            bus.bus_move(0, by)
            by = -by

    def command(self):
        return [{"FILM": self.film, "PAGE": f"file://{self.page}"}.get(word, word) for word in self.COMMAND]

    def start_felt(self):
        player = self.start(self.felt(*self.command()), self.ENV)
        self.assertTrue(comes(lambda: self.force_now_N() > .1), "nothing is felt: " + self.seen())
        return player

    def ticks(self):
        return bus_case.read_trace(self.trace)

    def force_now_N(self):
        """The largest of the newest 100 ticks; zero unless it plays."""
        ticks = self.ticks()[-100:]
        return bus_case.largest_N(ticks) if len(ticks) == 100 and ticks[-1][3] else 0

    def paused_s(self):
        ticks = self.ticks()
        return ticks[-1][0] - max((time for time, _, _, playing in ticks if playing), default=ticks[-1][0])

    def seen(self):
        ticks = self.ticks()
        return (f"{len(ticks)} ms traced, playing in {sum(tick[3] for tick in ticks)}, at most "
                f"{bus_case.largest_N(ticks):.2f} N; {self.opened()} devices opened")

    def expect_over(self):
        """No process can set the motors any more, and they are at zero."""
        self.assertTrue(comes(lambda: not processes_with("libgstspidar.so") and not processes_with("emulated-guardian")
                              and bus.bus_at_rest(0)), "the motors are not at zero")

    def expect_rest_while_paused(self):
        """Counted in ticks of the loop: on a machine that is too busy to run it, no force changes. Nor does it in a tick
        that the device does not answer in time."""
        paused = repeated = last_N = 0
        for _, _, force, playing in self.ticks():
            if playing:
                paused = repeated = 0
                continue
            repeated = repeated + 1 if force and force == last_N else 0
            paused += repeated == 0 or repeated >= MAX_ERRORS
            self.assertTrue(paused <= RAMP_TICKS or force == 0, f"{force} N {paused} ticks after it was paused")
            last_N = force

    def toggle(self, player):
        press(self.TOGGLE) if self.TOGGLE else player.send_signal(signal.SIGUSR1)

    def quit(self, player):
        if self.QUIT is None:
            player.send_signal(signal.SIGUSR2)
        elif " " in self.QUIT:
            self.run_in_folder(self.QUIT)
        else:
            press(self.QUIT)

    def test_it_is_felt_while_it_plays_and_at_rest_while_paused_and_after_quit(self):
        player = self.start_felt()
        self.assertFalse(bus.bus_at_rest(0))
        self.toggle(player)
        self.assertTrue(comes(lambda: self.paused_s() > .5), "it does not pause")
        self.toggle(player)
        self.assertTrue(comes(lambda: self.force_now_N() > .1), "nothing is felt after a pause: " + self.seen())
        self.expect_rest_while_paused()
        self.quit(player)
        self.assertTrue(comes(lambda: player.poll() is not None), "it does not quit")
        self.expect_over()

    def test_it_is_at_rest_after_a_signal(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            player = self.start_felt()
            player.send_signal(number)
            player.wait()
            self.expect_over()

    def test_without_spidar_feel_nothing_of_this_plugin_is_there(self):
        self.start(self.command(), self.ENV)
        # The decoder.
        self.assertTrue(comes(lambda: processes_with("libgstvpx.so")), "it does not play")
        time.sleep(1)
        self.assertEqual((processes_with("libgstspidar.so"), self.opened()), ([], 0))


class Totem(Player, PlayerCase):
    COMMAND = ("totem", "FILM")
    QUIT = "totem --quit"


class Parole(Player, PlayerCase):
    COMMAND = ("parole", "FILM")


class Showtime(Player, PlayerCase):
    COMMAND = ("showtime", "FILM")


class Clapper(Player, PlayerCase):
    COMMAND = ("clapper", "FILM")


class GtkVideo(Player, PlayerCase):
    COMMAND = (sys.executable, HERE / "gtk_video.py", "FILM")
    CHECK = (sys.executable, HERE / "gtk_video.py", "--check")
    # Without OpenGL: Mesa's renderer in software crashes now and then, also without spidar-feel.
    ENV = {"GDK_DEBUG": "gl-disable"}
    TOGGLE = QUIT = None
    NEEDS_SESSION = False


class WebKitGtk(Player, PlayerCase):
    COMMAND = (sys.executable, HERE / "web_video.py", "PAGE")
    CHECK = (sys.executable, HERE / "web_video.py", "--check")
    QUIT = None


class GnomeWeb(Player, PlayerCase):
    COMMAND = ("epiphany", "--private-instance", "PAGE")
    # The sandbox of its pages hides devices, files and what is preloaded.
    ENV = {"WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS": "1"}


class Lookers(PlayerCase):
    """What looks at films opens no device."""
    def look(self, *command):
        if not shutil.which(command[0]):
            self.skipTest(f"{command[0]} is not installed")
        self.assertEqual(self.start(self.felt(*command)).wait(), 0)
        self.assertEqual(self.opened(), 0)
        self.assertFalse(self.trace.exists())

    def test_gst_discoverer(self):
        self.look("gst-discoverer-1.0", self.film)

    def test_totem_video_thumbnailer(self):
        self.look("totem-video-thumbnailer", self.film, self.picture)
        self.assertGreater(self.picture.stat().st_size, 100)


if __name__ == "__main__":
    if IN_SESSION not in os.environ:
        run_in_session()
    unittest.main()
