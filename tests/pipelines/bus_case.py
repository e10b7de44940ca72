# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""For tests with boards on an emulated USB, which this process and those that it starts share: its library is preloaded
into all of them (LD_PRELOAD). SPIDAR_FEEL names the program spidar-feel."""

import csv
import ctypes
import enum
import math
import os
import subprocess
import tempfile
import time

import track_case

FEEL = os.environ["SPIDAR_FEEL"]
PROFILE = "profile=spidar-g6x3-v2-r"


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


def read_trace(path):
    """(monotonic s, running s, force N, whether it plays) of each tick in a haptic trace, which may still be written."""
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="ascii") as file:
        whole = file.read().rpartition("\n")[0].splitlines()
    return [(int(row["monotonic_ns"]) * 1e-9, int(row["running_ns"]) * 1e-9,
             math.hypot(*(float(row[f"commanded_force_{axis}_N"]) for axis in "xyz")), row["playing"] == "1")
            for row in csv.DictReader(whole)]


def largest_N(ticks):
    return max((force for _, _, force, _ in ticks), default=0)


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
        """Runs a command and returns what it has printed. A player that gets no processor time for 50 ms is set to rest by
        its guardian and opens the device once more: on a machine that is so busy, the command runs again; the test has a
        limit. opened() counts what the last of them has opened."""
        while True:
            before = bus.bus_files_opened()
            said = self.run_in_folder(command, None)
            if "guardian" not in said:
                break
            print("This machine is busy, so this runs again:", said)
            self.opened_before += bus.bus_files_opened() - before
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

    def expect_felt(self):
        self.assertGreater(largest_N(read_trace(self.trace)), .1)
        self.assertTrue(bus.bus_at_rest(0))
