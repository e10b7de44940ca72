# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A window that fills the screen while a clip plays, without taking the keys from the terminal that asks the questions."""

import contextlib
import ctypes
import os
import struct

import gi

gi.require_version("GstVideo", "1.0")
from gi.repository import Gst, GstVideo  # noqa: E402

# Of X.h, Xatom.h and Xutil.h
REPLACE, ATOM, INPUT_HINT = 0, 4, 1
WM_HINTS_WORDS = 9  # flags, input, and what these flags leave out


def open_window(x):
    """Black, as large as the screen, and for the window manager a full one. Nothing closes it but this program."""
    x.XOpenDisplay.restype = x.XInternAtom.restype = x.XDefaultRootWindow.restype = x.XCreateSimpleWindow.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x.XOpenDisplay(None))
    if not display:
        return None, 0
    root, number = ctypes.c_ulong(x.XDefaultRootWindow(display)), x.XDefaultScreen(display)
    window = ctypes.c_ulong(x.XCreateSimpleWindow(display, root, 0, 0, x.XDisplayWidth(display, number),
                                                  x.XDisplayHeight(display, number), 0, 0, 0))
    atom = lambda name: x.XInternAtom(display, name, 0)
    for name, kind, words in ((b"_NET_WM_STATE", ATOM, [atom(b"_NET_WM_STATE_FULLSCREEN")]),
                              (b"WM_PROTOCOLS", ATOM, [atom(b"WM_DELETE_WINDOW")]),
                              (b"WM_HINTS", atom(b"WM_HINTS"), [INPUT_HINT, *[0] * (WM_HINTS_WORDS - 1)])):
        x.XChangeProperty(display, window, ctypes.c_ulong(atom(name)), ctypes.c_ulong(kind), 32, REPLACE,
                          struct.pack(f"{len(words)}L", *words), len(words))
    x.XMapRaised(display, window)
    x.XSync(display, 0)
    return display, window.value


class FullScreen:
    """Of a pipeline, from before it plays until close(). Where there is no X, a sink that can fills the screen itself."""

    def __init__(self, pipeline):
        self.display, self.window = None, 0
        with contextlib.suppress(OSError):
            self.x = ctypes.CDLL("libX11.so.6")
            if "WAYLAND_DISPLAY" not in os.environ:  # whose sinks take other handles
                self.display, self.window = open_window(self.x)
        pipeline.bus.set_sync_handler(self.give)
        pipeline.connect("deep-element-added", self.fill)

    def fill(self, _, __, element):
        if element.find_property("fullscreen"):
            element.set_property("fullscreen", True)

    def give(self, _, message):
        if self.window and GstVideo.is_video_overlay_prepare_window_handle_message(message):
            message.src.set_window_handle(self.window)
            return Gst.BusSyncReply.DROP
        return Gst.BusSyncReply.PASS

    def close(self):
        if self.display:
            self.x.XCloseDisplay(self.display)
            self.display = None
