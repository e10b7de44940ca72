#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a film and prints the force of each frame when the frame is shown: motion_messages.py [--headless] FILE-OR-URI

A message `spidar-motion` comes when its frame is analysed. Behind a queue, as in playbin, that is up to a second before
the frame is shown; its `running-time` says when to use it. Needs python3-gi and gir1.2-gstreamer-1.0.
"""
import signal
import sys
from collections import deque

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
headless = "--headless" in sys.argv
name = sys.argv[-1]
player = Gst.ElementFactory.make("playbin")
player.set_property("uri", name if "://" in name else Gst.filename_to_uri(name))
player.set_property("video-filter", Gst.parse_launch("spidarmotion"))
if headless:
    for sink in "video-sink", "audio-sink":
        player.set_property(sink, Gst.parse_launch("fakesink sync=true"))
main = GLib.MainLoop()
problems = []
waiting = deque()  # structures of the messages of frames that are not shown yet


def handle(_bus, message):
    if message.type == Gst.MessageType.ELEMENT and message.has_name("spidar-motion"):
        frame = message.get_structure().copy()
        if waiting and frame.get_value("running-time") < waiting[-1].get_value("running-time"):
            waiting.clear()  # a seek: other frames come, and running time begins again
        waiting.append(frame)
    elif message.type == Gst.MessageType.WARNING:
        print(message.parse_warning()[0].message, file=sys.stderr)
    elif message.type == Gst.MessageType.ERROR:
        problems.append(message.parse_error()[0].message)
        main.quit()
    elif message.type == Gst.MessageType.EOS:
        main.quit()


def show_what_is_due():
    now = player.get_current_running_time()  # stands still while the film is paused
    while waiting and now != Gst.CLOCK_TIME_NONE and waiting[0].get_value("running-time") <= now:
        frame = waiting.popleft()
        print(f"{now / Gst.SECOND:7.3f} s: frame of {frame.get_value('running-time') / Gst.SECOND:.3f} s, force "
              f"{frame.get_value('force-x'):+.2f} {frame.get_value('force-y'):+.2f} N", flush=True)
    return GLib.SOURCE_CONTINUE


player.bus.add_signal_watch()
player.bus.connect("message", handle)
GLib.timeout_add(5, show_what_is_due)
player.set_state(Gst.State.PLAYING)
main.run()
player.set_state(Gst.State.NULL)
if problems:
    sys.exit(f"{name}: {problems[0]}")
