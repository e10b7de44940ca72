#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""play_film.py FOLDER PLAY...: plays films one after the other, and prints what happened as JSON.

A PLAY is a JSON object: "name", "player" (playbin, playbin3, gapless, decodebin), "film", and optionally
"properties" of a spidarmotion that is its filter, "sync" (in real time, with a trace of what is felt), and
"until_s", the running time at which a film whose sound goes on is stopped."""
import csv
import json
import os
import sys
from pathlib import Path

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

GRACE_S = 0.4  # for what is felt after the last picture
LONGEST_S = 60


def read_ticks(file):
    """Running time, wanted force to the right and upwards, and size of the force that is felt, of each tick while it
    plays."""
    with open(file, newline="") as rows:
        for row in csv.DictReader(rows):
            if row["playing"] == "1":
                felt_N = sum(float(row[f"commanded_force_{axis}_N"]) ** 2 for axis in "xyz") ** 0.5
                wanted = (float(row[f"wanted_force_{axis}_N"]) for axis in "xy")
                yield [1e-9 * int(row["running_ns"]), *wanted, felt_N]


def sink(sync, seen):
    """A screen behind a queue that holds the whole film, so that all pictures are analysed before they are due,
    however busy the machine is."""
    screen = Gst.parse_bin_from_description(
        "queue max-size-buffers=0 max-size-bytes=0 max-size-time=0 ! "
        f"fakesink name=screen sync={str(sync).lower()}", True)
    pad = screen.get_by_name("screen").get_static_pad("sink")

    def saw(pad, info):
        segment = pad.get_sticky_event(Gst.EventType.SEGMENT, 0).parse_segment()
        pts = info.get_buffer().pts
        seen.append([segment.to_stream_time(Gst.Format.TIME, pts), segment.to_running_time(Gst.Format.TIME, pts)])
        return Gst.PadProbeReturn.OK

    pad.add_probe(Gst.PadProbeType.BUFFER, saw)
    return screen


class Play:
    def __init__(self, play, folder, ended):
        self.name, self.play, self.ended = play["name"], play, ended
        self.seen, self.warnings, self.error, self.done = [], [], None, False
        self.sync = play.get("sync", False)
        self.ticks_file = os.path.join(folder, f"ticks-{self.name}.csv") if self.sync else None
        self.motion = None
        if "properties" in play:
            self.motion = Gst.ElementFactory.make("spidarmotion")
            for name, value in {"post-messages": "false", "haptic-trace": self.ticks_file, **play["properties"]}.items():
                if value is not None:
                    Gst.util_set_object_arg(self.motion, name, value)
        uri = Path(play["film"]).as_uri()
        make = self.decodebin if play["player"] == "decodebin" else self.playbin
        self.pipeline = make(uri, sink(self.sync, self.seen))
        bus = self.pipeline.get_bus()
        bus.add_signal_watch()
        bus.connect("message", self.message)

    def playbin(self, uri, screen):
        gapless = self.play["player"] == "gapless"
        player = Gst.ElementFactory.make("playbin3" if gapless else self.play["player"])
        player.set_property("uri", uri)
        player.set_property("video-sink", screen)
        player.set_property("audio-sink", Gst.parse_launch(f"fakesink sync={str(self.sync).lower()}"))
        if self.motion:
            player.set_property("video-filter", self.motion)
        if gapless:
            films = [uri]  # the same film once more
            player.connect("about-to-finish", lambda p: films and p.set_property("uri", films.pop()))
        return player

    def decodebin(self, uri, screen):
        pipeline = Gst.Pipeline()
        source = Gst.Element.make_from_uri(Gst.URIType.SRC, uri, None)
        decoder, convert = Gst.ElementFactory.make("decodebin"), Gst.ElementFactory.make("videoconvert")
        chain = [convert, *([self.motion] if self.motion else []), screen]
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
        self.pipeline.set_state(Gst.State.PLAYING)
        if self.sync and "until_s" in self.play:
            GLib.timeout_add(50, self.check_time)

    def check_time(self):
        if self.done:
            return False
        clock = self.pipeline.get_clock()
        playing = self.pipeline.get_state(0).state == Gst.State.PLAYING
        end = (self.play["until_s"] + GRACE_S) * Gst.SECOND
        if clock and playing and clock.get_time() - self.pipeline.base_time > end:
            self.stop()
        return not self.done

    def message(self, _, message):
        if message.type == Gst.MessageType.ERROR:
            self.error = message.parse_error()[0].message
        if message.type == Gst.MessageType.WARNING:
            self.warnings.append(message.parse_warning()[0].message)
        if message.type in (Gst.MessageType.ERROR, Gst.MessageType.EOS):
            self.stop()

    def give_up(self):
        self.error = f"not at its end after {LONGEST_S} s"
        self.stop()
        return True  # it is removed by the caller

    def stop(self):
        if self.done:
            return
        self.done = True
        self.stats = self.motion.get_property("stats") if self.motion else None
        self.pipeline.set_state(Gst.State.NULL)
        self.ended()

    def result(self):
        count = (lambda name: self.stats.get_value(name)) if self.stats else (lambda name: None)
        return {"frames": [[1e-9 * s, 1e-9 * r] for s, r in self.seen], "warnings": self.warnings, "error": self.error,
                "analysed": count("frames"), "of track": count("track-frames"),
                "ticks": list(read_ticks(self.ticks_file)) if self.sync else None}


def main():
    Gst.init(None)
    loop = GLib.MainLoop()
    results = {}
    for text in sys.argv[2:]:
        play = Play(json.loads(text), sys.argv[1], loop.quit)
        limit = GLib.timeout_add_seconds(LONGEST_S, play.give_up)
        play.start()
        loop.run()
        GLib.source_remove(limit)
        results[play.name] = play.result()
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main()
