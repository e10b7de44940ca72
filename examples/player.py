#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a film, renders its motion as force, and shows it: player.py [--headless] FILE-OR-URI

Type and return: space pause, + - speed, < > 5 s, . next frame, l loop, f force on and off,
d40 force 40 ms later, q quit. Needs python3-gi and gir1.2-gstreamer-1.0, and GST_PLUGIN_PATH as in
docs/start.md.
"""
import re
import signal
import sys
import threading

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

headless = "--headless" in sys.argv
names = [argument for argument in sys.argv[1:] if argument != "--headless"]
if len(names) != 1 or names[0].startswith("-"):
    sys.exit(__doc__)
signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl+C ends it
Gst.init(None)
motion = Gst.parse_launch("spidarmotion overlay=force")
screen = Gst.parse_launch("fakesink sync=true" if headless else "autovideosink")
sound = Gst.parse_launch("fakesink sync=true" if headless else "autoaudiosink")
player = Gst.ElementFactory.make("playbin")
for key, value in {"video-filter": motion, "video-sink": screen, "audio-sink": sound}.items():
    player.set_property(key, value)
player.set_property("uri", names[0] if "://" in names[0] else Gst.filename_to_uri(names[0]))
main = GLib.MainLoop()
rate, playing, again, failed = 1.0, True, False, False


def jump(seconds, start=None):
    position = player.query_position(Gst.Format.TIME)[1] if start is None else start
    player.seek(rate, Gst.Format.TIME, Gst.SeekFlags.FLUSH | Gst.SeekFlags.ACCURATE, Gst.SeekType.SET,
                max(position + seconds * Gst.SECOND, 0), Gst.SeekType.NONE, 0)


def act(line):
    global rate, playing, again
    key = line[:1]
    if key == "q":
        main.quit()
    elif key in (" ", "."):
        playing = not playing and key == " "
        player.set_state(Gst.State.PLAYING if playing else Gst.State.PAUSED)
        player.get_state(5 * Gst.SECOND)
        if key == ".":
            screen.send_event(Gst.Event.new_step(Gst.Format.BUFFERS, 1, 1.0, True, False))
    elif key in ("+", "-"):
        rate = min(max(rate * (2 if key == "+" else 0.5), 0.25), 4)
        jump(0)
    elif key in ("<", ">"):
        jump(5 if key == ">" else -5)
    elif key == "l":
        again = not again
    elif key == "f":
        motion.set_property("mute", not motion.get_property("mute"))
    elif re.fullmatch("d-?[0-9]{1,4}\n", line):
        motion.set_property("ts-offset", int(line[1:]) * Gst.MSECOND)
    player.get_state(5 * Gst.SECOND)
    stats = motion.get_property("stats")
    right, up = (stats.get_value(f"force-{axis}") or 0 for axis in "xy")
    print(f"{max(player.query_position(Gst.Format.TIME)[1], 0) / Gst.SECOND:.2f} s, {rate:g}x, "
          f"{'playing' if playing else 'paused'}{', loop' if again else ''}, "
          f"force {'off' if motion.get_property('mute') else 'on'}, {right:+.2f} N right, {up:+.2f} N up, "
          f"delay {motion.get_property('ts-offset') // Gst.MSECOND} ms", flush=True)


def handle(_bus, message):
    global failed
    if message.type == Gst.MessageType.EOS and again:
        jump(0, 0)
    elif message.type in (Gst.MessageType.ERROR, Gst.MessageType.EOS):
        failed = message.type == Gst.MessageType.ERROR
        if failed:
            error, detail = message.parse_error()
            print(f"{names[0]}: {error.message} ({detail.splitlines()[-1]})", file=sys.stderr)
        main.quit()
    elif message.type == Gst.MessageType.ASYNC_DONE and player.get_property("n-video") == 0:
        failed = True
        print(f"{names[0]}: there is no video in it", file=sys.stderr)
        main.quit()


player.bus.add_signal_watch()
player.bus.connect("message", handle)
player.set_state(Gst.State.PLAYING)
player.get_state(5 * Gst.SECOND)
threading.Thread(target=lambda: [GLib.idle_add(act, line) for line in sys.stdin], daemon=True).start()
main.run()
player.set_state(Gst.State.NULL)
sys.exit(failed)
