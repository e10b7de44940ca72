#!/usr/bin/env python3
"""Plays FILE-OR-URI with its motion in the hand: player.py [--headless] FILE-OR-URI

Type space pause, + - speed, < > 5 s, f force on and off, d40 force 40 ms later, q quit; and return.
Needs python3-gi and gir1.2-gstreamer-1.0, and GST_PLUGIN_PATH as in README.md.
"""
import sys

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

Gst.init(None)
name = sys.argv[-1]
motion = Gst.ElementFactory.make("spidarmotion")
player = Gst.ElementFactory.make("playbin")
player.set_property("uri", name if Gst.uri_is_valid(name) else Gst.filename_to_uri(name))
player.set_property("video-filter", motion)
if "--headless" in sys.argv:
    for sink in "video-sink", "audio-sink":
        player.set_property(sink, Gst.parse_launch("fakesink sync=true"))
loop = GLib.MainLoop()
rate, playing = 1.0, True


def jump(seconds):
    position = player.query_position(Gst.Format.TIME)[1] + seconds * Gst.SECOND
    player.seek(rate, Gst.Format.TIME, Gst.SeekFlags.FLUSH | Gst.SeekFlags.ACCURATE,
                Gst.SeekType.SET, max(position, 0), Gst.SeekType.NONE, 0)


def act(source, _condition):
    global rate, playing
    line = source.readline()
    key = line.rstrip("\n")[:1]
    if key == " ":
        playing = not playing
        player.set_state(Gst.State.PLAYING if playing else Gst.State.PAUSED)
    elif key in ("+", "-"):
        rate = min(max(rate * (2 if key == "+" else 0.5), 0.25), 4)
        jump(0)
    elif key in ("<", ">"):
        jump(5 if key == ">" else -5)
    elif key == "f":
        motion.set_property("mute", not motion.get_property("mute"))
    elif key == "d":
        motion.set_property("ts-offset", int(line[1:]) * Gst.MSECOND)
    elif key == "q":
        loop.quit()
    player.get_state(5 * Gst.SECOND)
    print(f"{player.query_position(Gst.Format.TIME)[1] / Gst.SECOND:.1f} s, {rate:g}x, "
          f"{'playing' if playing else 'paused'}, "
          f"force {'off' if motion.get_property('mute') else 'on'}, "
          f"delay {motion.get_property('ts-offset') // Gst.MSECOND} ms", flush=True)
    return bool(line)


def end(_bus, message):
    if message.type == Gst.MessageType.ERROR:
        print(message.parse_error().gerror.message, file=sys.stderr)
    if message.type in (Gst.MessageType.ERROR, Gst.MessageType.EOS):
        loop.quit()


player.bus.add_signal_watch()
player.bus.connect("message", end)
player.set_state(Gst.State.PLAYING)
player.get_state(5 * Gst.SECOND)
GLib.io_add_watch(sys.stdin, GLib.PRIORITY_DEFAULT, GLib.IOCondition.IN | GLib.IOCondition.HUP, act)
loop.run()
player.set_state(Gst.State.NULL)
