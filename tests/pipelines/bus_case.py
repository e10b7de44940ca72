# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""For tests with boards on an emulated USB, which this process and those that it starts share: its library is preloaded
into all of them (LD_PRELOAD). SPIDAR_FEEL names the program spidar-feel."""

import ctypes
import enum
import os
import re
import subprocess
import tempfile
import time

import track_case
from haptic_trace import largest_N, read_trace

FEEL = os.environ["SPIDAR_FEEL"]
PROFILE = "profile=spidar-g6x3-v2-r"
# What a player is told that gets no processor time: its guardian sets the device to rest after 50 ms.
BUSY = r"[^\n]*(set to rest, because the player stood still|late\b|lacks \d+ rows)[^\n]*\n"


class Evdev(enum.IntEnum):
    """Input devices, in the order of EvdevKind."""
    STICK = 1
    WHEEL = 2
    PAD = 3
    KEYBOARD = 4


_file = tempfile.NamedTemporaryFile(prefix="spidar-bus-")
os.environ["SPIDAR_EMULATED_BUS"] = _file.name
bus = ctypes.CDLL(None)
for _name in ("bus_at_rest", "evdev_at_rest", "evdev_plays"):
    getattr(bus, _name).restype = ctypes.c_bool
for _name in ("bus_updates", "bus_files_opened", "evdev_uploads"):
    getattr(bus, _name).restype = ctypes.c_uint64


def wait_for(condition):
    """Waits without a limit; the test has one."""
    while not condition():
        time.sleep(.001)


class BusCase(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        bus.bus_clear()
        self.addCleanup(bus.bus_clear)
        self.opened_before = bus.bus_files_opened()
        self.trace = self.path("trace.csv")

    def opened(self):
        """How often a device was opened since the test began."""
        return bus.bus_files_opened() - self.opened_before

    def felt(self, *command):
        """The command with a board, and a new trace."""
        self.trace.unlink(missing_ok=True)
        return [FEEL, "device=usb", PROFILE, "motion=mean", f"haptic-trace={self.trace}", "--", *map(str, command)]

    def run_all(self, command, status=0):
        """Runs a command and returns what it has printed, but for what is BUSY."""
        said = re.sub(BUSY, "", self.run_in_folder(command, None))
        if status is not None:
            self.assertEqual(self.status, status, said)
        return said

    def end_while_felt(self, command, number, at_rest=lambda: bus.bus_at_rest(0)):
        """Starts a player, ends it with a signal while it is felt, and waits for the device to be at rest."""
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL) as running:
            wait_for(lambda: not at_rest() or running.poll() is not None)
            self.assertIsNone(running.poll())
            running.send_signal(number)
            running.wait()
            wait_for(at_rest)
