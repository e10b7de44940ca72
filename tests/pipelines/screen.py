# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""An X server without a screen, for windows of players, and xdotool, which moves the mouse and presses keys there."""

import ctypes
import os
import shutil
import subprocess
import time
import unittest


class Screen:
    """Xvfb on a free display, which DISPLAY names from then on."""

    def __init__(self):
        self.why_not = "Xvfb, which shows windows, is not installed" if not shutil.which("Xvfb") else ""
        if not self.why_not and not shutil.which("xdotool"):
            self.why_not = "xdotool, which moves the mouse and presses keys, is not installed"
        # Servers that start at the same time may choose the same display; one of them then gives up.
        for _ in range(0 if self.why_not else 20):
            read, write = os.pipe()
            self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-noreset",
                                            "-nolisten", "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL)
            os.close(write)
            with os.fdopen(read) as number:
                display = number.read().strip()
            if display:
                os.environ["DISPLAY"] = ":" + display
                os.environ.pop("WAYLAND_DISPLAY", None)
                return
            self.server.wait()
            time.sleep(.05)
        self.why_not = self.why_not or "Xvfb does not start"

    def stop(self):
        if not self.why_not:
            self.server.kill()
            self.server.wait()


def xdotool(*words):
    return subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True, check=True).stdout


def set_property(window, name, kind, bits, data):
    """As any program may set it; `window` is a number as xdotool writes it, None the root."""
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XDefaultRootWindow.restype = x11.XInternAtom.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    atoms = [ctypes.c_ulong(x11.XInternAtom(display, each.encode(), 0)) for each in (name, kind)]
    of = ctypes.c_ulong(int(window) if window else x11.XDefaultRootWindow(display))
    x11.XChangeProperty(display, of, *atoms, bits, 0, data, len(data) * 8 // bits)
    x11.XCloseDisplay(display)


def windows():
    """All that are visible, the newest last."""
    found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "."], capture_output=True, text=True, check=False)
    return found.stdout.split()


def comes(condition):
    """Waits until it is so; false when it is not within a minute, a hundred times what it takes."""
    until = time.monotonic() + 60
    while not condition():
        if time.monotonic() > until:
            return False
        time.sleep(.03)
    return True


class ScreenCase(unittest.TestCase):
    """Mixed into tests that need a screen."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.screen = Screen()
        cls.addClassCleanup(cls.screen.stop)
        if cls.screen.why_not:
            raise unittest.SkipTest(cls.screen.why_not)

    def setUp(self):
        super().setUp()
        # The windows of an earlier test close a moment after its programs have ended.
        self.assertTrue(comes(lambda: not windows()), "windows of an earlier test stay open")
