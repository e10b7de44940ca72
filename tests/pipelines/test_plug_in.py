# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The rehearsal of docs/when-it-goes-wrong.md: what plug_in does to an emulated board and the grip on its strings is noticed
by the programs that use the board, and named. None of these waits has a limit but that of the test."""

import contextlib
import os
import re
import signal
import subprocess
import time
import unittest

import track_case

PLUG_IN, SPIDARCTL = os.environ["PLUG_IN"], os.environ["SPIDARCTL"]
PROFILE = "spidar-g6x3-v2-r"
FILM = ("gst-launch-1.0", "videotestsrc", "pattern=ball", "!", "video/x-raw,width=160,height=120", "!", "spidarmotion",
        "device=usb", f"profile={PROFILE}", "!", "fakesink", "sync=true")


class PlugIn(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.log = self.path("log")
        self.variables = os.environ | {"XDG_CONFIG_HOME": str(self.folder), "TMPDIR": str(self.folder)}

    def begin(self, *command):
        """A board for a command."""
        with open(self.log, "w", encoding="utf-8") as log:
            running = subprocess.Popen([PLUG_IN, "sh4", "--profile", PROFILE, *command], stdin=subprocess.PIPE, stdout=log,
                                       stderr=log, text=True, env=self.variables, start_new_session=True)
        self.addCleanup(running.wait)
        self.addCleanup(running.stdin.close)
        self.addCleanup(self.end, running)
        self.variables["SPIDAR_EMULATED_BUS"] = self.wait_for(r"export SPIDAR_EMULATED_BUS=(\S+)\n")[1]
        return running

    @staticmethod
    def end(running):
        """With what it has started."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)

    def act(self, *words, status=0):
        done = subprocess.run([PLUG_IN, *words], env=self.variables, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def said(self):
        return self.log.read_text(encoding="utf-8")

    def wait_for(self, what, times=1):
        """Until that has been said so often."""
        while True:
            found = list(re.finditer(what, self.said()))
            if len(found) >= times:
                return found[-1]
            time.sleep(.01)

    def begin_film(self):
        """One that is felt."""
        film = self.begin("sh", "-c", "while true; do " + " ".join(FILM) + "; done")
        self.wait_for(r"digits:(?! +0 +0 +0 +0 +0 +0 +0 +0\n)")
        return film


class Rehearsal(PlugIn):
    def test_a_broken_string_is_named(self):
        self.begin_film()
        self.act("break", "3")
        self.wait_for("String 3 of the haptic device is slack or broken")

    def test_a_board_that_was_without_power_is_not_believed(self):
        """Its counters begin where the grip is then, as if that were the centre."""
        self.begin_film()
        self.act("move", "25", "0", "0")
        self.act("restart")
        self.wait_for("usb: was without power, its counters do not say any more where the grip is: hold the grip at the centre, "
                      "and stop and start")

    def test_a_selftest_says_that_a_string_may_be_broken(self):
        self.begin("sh", "-c", f"plug_in break 3; {SPIDARCTL} selftest usb --profile {PROFILE} --yes; read wait")
        self.wait_for("encoder 3 ran by [0-9]+ mm .*string 3 is broken")

    def test_two_boards_a_pad_and_a_missing_permission(self):
        self.begin("sh", "-c", f"plug_in second; plug_in pad; {SPIDARCTL} list; plug_in forbid; {SPIDARCTL} list; read wait")
        self.wait_for("usb:1-1 (.*\\n)*.*usb:1-2 ")
        self.wait_for("Emulated Pad")
        self.wait_for("70-spidar.rules")

    def test_what_cannot_be_done_is_refused(self):
        self.variables["SPIDAR_EMULATED_BUS"] = str(self.path("none"))
        self.assertIn("no board is plugged in: begin with plug_in sh4", self.act("stop", status=2))
        self.begin("sleep", "1000")
        self.assertIn('a string is a whole number from 0 to 7, not "8"', self.act("break", "8", status=2))
        self.assertIn("it is: plug_in move X Y Z, or move about", self.act("move", "1", "2", status=2))
        self.assertIn('no board on USB is called "swing"', self.act("swing", status=2))


if __name__ == "__main__":
    unittest.main()
