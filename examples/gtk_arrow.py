#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a film beside a window of GTK 4 with its force as an arrow: gtk_arrow.py FILE-OR-URI

The arrow is that of the frame on the screen: a message is used at its `running-time` (motion_messages.py says why).
Needs python3-gi, gir1.2-gstreamer-1.0 and gir1.2-gtk-4.0.
"""
import math
import signal
import sys
from collections import deque

import gi

gi.require_version("Gst", "1.0")
gi.require_version("Gtk", "4.0")
from gi.repository import GLib, Gst, Gtk  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
name = sys.argv[1]
player = Gst.ElementFactory.make("playbin")
player.set_property("uri", name if "://" in name else Gst.filename_to_uri(name))
player.set_property("video-filter", Gst.parse_launch("spidarmotion"))
waiting = deque()  # structures of the messages of frames that are not shown yet
app = Gtk.Application()


def handle(_bus, message):
    if message.type == Gst.MessageType.ELEMENT and message.has_name("spidar-motion"):
        waiting.append(message.get_structure().copy())
    elif message.type in (Gst.MessageType.ERROR, Gst.MessageType.EOS):
        app.quit()


def show_what_is_due(label, _clock):
    now = player.get_current_running_time()
    while waiting and now != Gst.CLOCK_TIME_NONE and waiting[0].get_value("running-time") <= now:
        frame = waiting.popleft()
        right, up = frame.get_value("force-x"), frame.get_value("force-y")
        arrow = "→↗↑↖←↙↓↘"[round(math.atan2(up, right) / math.radians(45)) % 8]
        size_pt = 20 + 40 * math.hypot(right, up)
        label.set_markup(f'<span size="{round(size_pt)}pt">{arrow}</span>\n{right:+.2f} N right, {up:+.2f} N up')
    return GLib.SOURCE_CONTINUE


def activate(_app):
    window = Gtk.ApplicationWindow(application=app, title="Force", default_width=300, default_height=300)
    label = Gtk.Label(label="no force yet", justify=Gtk.Justification.CENTER)
    label.add_tick_callback(show_what_is_due)
    window.set_child(label)
    window.present()
    player.set_state(Gst.State.PLAYING)


player.bus.add_signal_watch()
player.bus.connect("message", handle)
app.connect("activate", activate)
app.run()
player.set_state(Gst.State.NULL)
