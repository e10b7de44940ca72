# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A simple player, of which only its tests know that it is felt: feel_player.py PLAYBIN FILM STEP... PLAYBIN is playbin
or playbin3. Steps are
  own-filter, own-sink    uses a video-filter, or a sink with spidarmotion device=none, of its own
  window                  uses a sink that accepts what a window accepts, without a converter
  preroll, play, pause, ready, stop, seek (to the beginning)
  other                   uses a second player from now on
  frames=N, wait=MS       waits until N more frames were shown; for MS milliseconds
  felt=TRACE, rest=TRACE  waits until the haptic trace has a force that plays, however often the film must begin again for
                          that, or the newest tick has none
  forget=TRACE            removes the trace
  end                     waits for the end of the film, and prints how many frames were shown and a checksum of them
  loaded                  prints whether the plugin is in this process
  stay, exit              waits for ever; exits without stopping"""

import ctypes
import hashlib
import os
import signal
import sys
import time

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst

from haptic_trace import largest_N, read_trace

STATES = {"preroll": Gst.State.PAUSED, "play": Gst.State.PLAYING, "pause": Gst.State.PAUSED, "ready": Gst.State.READY,
          "stop": Gst.State.NULL}
checksum = hashlib.md5()
frames_shown = 0


def see(_sink, frame, _pad):
    """In the streaming thread; the checksum is read when that has come to its end."""
    global frames_shown
    frames_shown += 1
    checksum.update(frame.pts.to_bytes(8, "little"))
    checksum.update(frame.extract_dup(0, frame.get_size()))


def watch(sink):
    """Shows every frame, also late ones."""
    for name, value in (("sync", True), ("qos", False), ("max-lateness", -1), ("signal-handoffs", True)):
        sink.set_property(name, value)
    sink.connect("handoff", see)
    return sink


def fail():
    sys.stderr.write("the player fails\n")
    sys.exit(1)


class Playbin:
    def __init__(self, name, film):
        self.pipeline = Gst.ElementFactory.make(name)
        self.sink = watch(Gst.ElementFactory.make("fakesink"))
        self.pipeline.set_property("uri", Gst.filename_to_uri(film))
        self.pipeline.set_property("video-sink", self.sink)

    def own_filter(self):
        self.pipeline.set_property("video-filter", Gst.ElementFactory.make("identity"))

    def own_sink(self):
        self.pipeline.set_property("video-sink", Gst.parse_bin_from_description(
            "videoconvert ! spidarmotion device=none ! fakesink sync=true", True))

    def window(self):
        """A format that graphics cards overlay, and no conversion by playbin itself. It is one that decoders of 10 bits
        have in their templates, too: playbin refuses a decoder none of whose formats the sink takes."""
        window = Gst.parse_bin_from_description("capsfilter caps=video/x-raw,format=I420 name=format", True)
        self.sink.unparent() if self.sink.get_parent() else None
        window.remove_pad(window.get_static_pad("src"))
        window.add(self.sink)
        window.get_by_name("format").link(self.sink)
        # Video, and no conversion (GST_PLAY_FLAG_NATIVE_VIDEO).
        self.pipeline.set_property("flags", 1 << 0 | 1 << 6)
        self.pipeline.set_property("video-sink", window)


def wait_for_end(pipeline):
    message = pipeline.get_bus().timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR)
    if message.type == Gst.MessageType.ERROR:
        fail()
    print(f"{frames_shown} frames, {checksum.hexdigest()}", flush=True)


def main(name, film, *steps):
    players = [Playbin(name, film) for _ in range(2)]
    player = players[0]
    for step in steps:
        word, _, number = step.partition("=")
        if word in STATES:
            player.pipeline.set_state(STATES[word])
            if player.pipeline.get_state(Gst.CLOCK_TIME_NONE)[0] == Gst.StateChangeReturn.FAILURE:
                fail()
        elif word == "seek":
            player.pipeline.seek_simple(Gst.Format.TIME, Gst.SeekFlags.FLUSH, 0)
        elif word == "end":
            wait_for_end(player.pipeline)
        elif word == "other":
            player = players[1]
        elif word == "frames":
            until = frames_shown + int(number)
            while frames_shown < until:
                time.sleep(.001)
        elif word == "felt":
            while largest_N([tick for tick in read_trace(number) if tick[3]]) < .1:
                if player.pipeline.get_bus().timed_pop_filtered(10 * Gst.MSECOND, Gst.MessageType.EOS):
                    player.pipeline.seek_simple(Gst.Format.TIME, Gst.SeekFlags.FLUSH, 0)
        elif word == "rest":
            while any(force or playing for _, _, force, playing in read_trace(number)[-1:]):
                time.sleep(.01)
        elif word == "forget":
            os.unlink(number)
        elif word == "wait":
            time.sleep(int(number) / 1000)
        elif word == "loaded":
            with open("/proc/self/maps", encoding="utf-8") as maps:
                print("loaded" if "libgstspidarfeel.so" in maps.read() else "not loaded", flush=True)
        elif word == "stay":
            signal.pause()
        elif word == "exit":
            ctypes.CDLL(None).exit(0)
        else:
            getattr(player, word.replace("-", "_"))()
    for one in players:
        one.pipeline.set_state(Gst.State.NULL)


signal.signal(signal.SIGINT, signal.SIG_DFL)
Gst.init(None)
main(*sys.argv[1:])
