#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays films. Each line on its input is a play, a JSON object; for each it prints one line of JSON, what happened:
so that GStreamer is loaded once and not for each film.

A play has "player" (playbin, playbin3, gapless, decodebin) and "film", and optionally "properties" of a spidarmotion
that is its filter, and "pictures": the film is played in real time, when so many pictures or all wait for the screen.
"ticks" names the file for the trace of what is felt then. "until_s" is the running time at which a film whose sound
goes on is stopped.

playbin3 of GStreamer 1.22 loses the end of some plays, with and without a filter, and gst_element_set_state(NULL) then
crashes in its decodebin3 more often than not. A play that does not end is therefore "hung": of it, only the element is
stopped, and this process ends after its line. Every other play is stopped as applications do, and a crash is one."""
import csv
import json
import os
import sys
from pathlib import Path

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

GRACE_S = 0.4  # for what is felt after the last picture
LOOK_S, SILENT_S = 10, 60  # how often it looks for progress, and after which time it hangs
END_S = 20  # the same, when all that is to be seen and felt was there
HANGS = f"no picture and no end for {SILENT_S} s"
LOSE_END = ("playbin3", "gapless")  # whose plays are good without an end if all else was there
UNLIMITED = "queue max-size-buffers=0 max-size-bytes=0 max-size-time=0"


def read_ticks(file):
    """Running time, wanted force to the right and upwards, and size of the force that is felt, of each tick while it
    plays."""
    with open(file, newline="") as rows:
        for row in csv.DictReader(rows):
            if row["playing"] == "1":
                felt_N = sum(float(row[f"commanded_force_{axis}_N"]) ** 2 for axis in "xyz") ** 0.5
                wanted = (float(row[f"wanted_force_{axis}_N"]) for axis in "xy")
                yield [1e-9 * int(row["running_ns"]), *wanted, felt_N]


class Play:
    def __init__(self, play, ended):
        self.play, self.ended = play, ended
        self.seen, self.warnings, self.error, self.done = [], [], None, False
        self.in_time = "pictures" in play
        self.hurried = False  # played before all pictures waited
        self.hung = False
        self.waiting = 0  # pictures that have come to the screen
        self.pictures = self.looks_in_vain = 0  # that have come and were shown, when looked at last
        self.motion = self.stats = None
        if "properties" in play:
            self.motion = Gst.ElementFactory.make("spidarmotion")
            for name, value in {"post-messages": "false", **play["properties"]}.items():
                Gst.util_set_object_arg(self.motion, name, value)
        uri = Path(play["film"]).as_uri()
        make = self.decodebin if play["player"] == "decodebin" else self.playbin
        self.pipeline = make(uri)
        bus = self.pipeline.get_bus()
        bus.add_signal_watch()
        bus.connect("message", self.message)

    def sink(self):
        """Of sound or pictures. Its queue takes the whole film, so that it is there before it is played, however busy
        the machine is."""
        return Gst.parse_bin_from_description(
            f"{UNLIMITED} name=waits ! fakesink name=end sync={str(self.in_time).lower()}", True)

    def screen(self):
        screen = self.sink()
        pad = screen.get_by_name("end").get_static_pad("sink")

        def shown(pad, info):
            segment = pad.get_sticky_event(Gst.EventType.SEGMENT, 0).parse_segment()
            pts = info.get_buffer().pts
            self.seen.append([segment.to_stream_time(Gst.Format.TIME, pts),
                              segment.to_running_time(Gst.Format.TIME, pts)])
            return Gst.PadProbeReturn.OK

        def comes(pad, info):
            ends = info.type & Gst.PadProbeType.EVENT_DOWNSTREAM and info.get_event().type == Gst.EventType.EOS
            self.waiting += bool(info.type & Gst.PadProbeType.BUFFER)
            if self.in_time and (ends or self.waiting == self.play["pictures"]):
                GLib.idle_add(self.begin)
            return Gst.PadProbeReturn.OK

        pad.add_probe(Gst.PadProbeType.BUFFER, shown)
        screen.get_by_name("waits").get_static_pad("sink").add_probe(
            Gst.PadProbeType.BUFFER | Gst.PadProbeType.EVENT_DOWNSTREAM, comes)
        return screen

    def playbin(self, uri):
        gapless = self.play["player"] == "gapless"
        player = Gst.ElementFactory.make("playbin3" if gapless else self.play["player"])
        player.set_property("uri", uri)
        player.set_property("video-sink", self.screen())
        player.set_property("audio-sink", self.sink())
        if self.motion:
            player.set_property("video-filter", self.motion)
        if gapless:
            films = [uri]  # the same film once more
            player.connect("about-to-finish", lambda p: films and p.set_property("uri", films.pop()))
        return player

    def decodebin(self, uri):
        pipeline = Gst.Pipeline()
        source = Gst.Element.make_from_uri(Gst.URIType.SRC, uri, None)
        decoder, convert = Gst.ElementFactory.make("decodebin"), Gst.ElementFactory.make("videoconvert")
        chain = [convert, *([self.motion] if self.motion else []), self.screen()]
        for element in (source, decoder, *chain):
            pipeline.add(element)
        source.link(decoder)
        for one, next_one in zip(chain, chain[1:]):
            one.link(next_one)

        def added(_, pad):
            into = convert.get_static_pad("sink")
            video = pad.query_caps(None).to_string().startswith("video/x-raw")
            if video and not into.is_linked():
                pad.link(into)

        decoder.connect("pad-added", added)
        return pipeline

    def start(self):
        self.pipeline.set_state(Gst.State.PAUSED if self.in_time else Gst.State.PLAYING)
        if "until_s" in self.play:
            GLib.timeout_add(50, self.check_time)

    def begin(self):
        """What is to be played in real time is waiting."""
        if not self.done:
            self.pipeline.set_state(Gst.State.PLAYING)

    def check_time(self):
        if self.done:
            return False
        clock = self.pipeline.get_clock()
        playing = self.pipeline.get_state(0).state == Gst.State.PLAYING
        end = (self.play["until_s"] + GRACE_S) * Gst.SECOND
        shown = len(self.seen) >= self.play["pictures"]  # on a busy machine, they may be late
        if clock and playing and shown and clock.get_time() - self.pipeline.base_time > end:
            self.stop()
        return not self.done

    def has_shown_all(self):
        films = 2 if self.play["player"] == "gapless" else 1
        return self.in_time and len(self.seen) >= films * self.play["pictures"]

    def message(self, _, message):
        if message.type == Gst.MessageType.ERROR:
            self.error = message.parse_error()[0].message
        if message.type == Gst.MessageType.WARNING:
            self.warnings.append(message.parse_warning()[0].message)
        if message.type in (Gst.MessageType.ERROR, Gst.MessageType.EOS):
            self.stop()

    def look_for_progress(self):
        pictures = self.waiting + len(self.seen)
        self.looks_in_vain = self.looks_in_vain + 1 if pictures == self.pictures else 0
        self.pictures = pictures
        silent_s = self.looks_in_vain * LOOK_S
        has_lost_end = self.play["player"] in LOSE_END and self.has_shown_all() and silent_s >= END_S
        if self.looks_in_vain == 1 and self.in_time and not self.has_shown_all():
            self.hurried = True  # some demuxers wait for the sink
            self.begin()
        elif has_lost_end or silent_s >= SILENT_S:
            self.error = None if has_lost_end else HANGS
            self.hung = True
            self.stop()
        return True  # it is removed by the caller

    def stop(self):
        if self.done:
            return
        self.done = True
        self.stats = self.motion.get_property("stats") if self.motion else None
        self.pipeline.get_bus().remove_signal_watch()
        if not self.hung:
            self.pipeline.set_state(Gst.State.NULL)
        elif self.motion:
            self.motion.set_locked_state(True)
            self.motion.set_state(Gst.State.NULL)
        self.ended()

    def result(self):
        count = (lambda name: self.stats.get_value(name)) if self.stats else (lambda name: None)
        has_ticks = "ticks" in self.play and not self.error  # a play that hangs may not have opened the device
        return {"frames": [[1e-9 * s, 1e-9 * r] for s, r in self.seen], "warnings": self.warnings, "error": self.error,
                "hurried": self.hurried, "hung": self.hung,
                "analysed": count("frames"), "of track": count("track-frames"),
                "ticks": list(read_ticks(self.play["ticks"])) if has_ticks else []}


def main():
    Gst.init(None)
    loop = GLib.MainLoop()
    for text in sys.stdin:
        play = Play(json.loads(text), loop.quit)
        limit = GLib.timeout_add_seconds(LOOK_S, play.look_for_progress)
        play.start()
        loop.run()
        GLib.source_remove(limit)
        print(json.dumps(play.result()), flush=True)
        if play.hung:
            os._exit(0)


if __name__ == "__main__":
    main()
