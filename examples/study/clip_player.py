# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays clips whose motion is felt, one after the other, on a device that stays open."""

import fcntl
import os
import select
import tempfile
import threading
import time
from contextlib import contextmanager

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

from full_screen import FullScreen  # noqa: E402
from screen import Screen  # noqa: E402

Gst.init(None)

SINKS = {"window": "autovideosink", "headless": "fakesink sync=true", "fast": "fakesink sync=false"}
SOUNDS = {"window": "autoaudiosink", "headless": "fakesink sync=true", "fast": "fakesink sync=false"}
# Frames are analysed before they are due, so that a busy machine is not late at once. 4 at 25/s are 160 ms.
AHEAD = "queue max-size-buffers=4 max-size-bytes=0 max-size-time=0"
PIPE_BYTES = 1 << 20  # two seconds of rows, which are dropped if nobody takes them
OPENING_S = 5
TRACE_LATE_S = 2  # how long to wait for the trace's rows, which are written every 50 ms


def uri_of(clip):
    """Raises ValueError if there is no such file."""
    try:
        with open(clip, "rb"):
            return Gst.filename_to_uri(os.path.abspath(clip))
    except OSError as error:
        raise ValueError(f"{clip}: {error.strerror}; give a video file") from error


def make_filter(properties):
    """spidarmotion with a list of name=value. Raises ValueError that says what is wrong."""
    try:
        return Gst.parse_launchv(["spidarmotion", *properties])
    except GLib.Error as error:
        if error.matches(Gst.parse_error_quark(), Gst.ParseError.NO_SUCH_ELEMENT):
            error.message += "; set GST_PLUGIN_PATH to the folder of its plugin, and write properties as name=value"
        raise ValueError(error.message) from error


def plugin_version():
    return Gst.Registry.get().find_feature("spidarmotion", Gst.ElementFactory).get_plugin().get_version()


@contextmanager
def noise(volume, output):
    """Pink noise, which hides the sound of the motors whatever is felt. `output`: one of SINKS. Raises RuntimeError."""
    pipeline = Gst.parse_launch(f"audiotestsrc wave=pink-noise volume={volume} ! {SOUNDS[output]}")
    try:
        if volume and pipeline.set_state(Gst.State.PLAYING) == Gst.StateChangeReturn.FAILURE:
            raise RuntimeError("the noise that hides the motors cannot be played: is there a sound card?")
        yield pipeline
    finally:
        pipeline.set_state(Gst.State.NULL)


def analyse(clip, upright, turned, tell):
    """Decodes a clip once, as fast as it can be analysed, for filters (make_filter()) of which some see it turned by 180°.
    `tell` is called with the per cent that are done. Raises RuntimeError."""
    pipeline = Gst.parse_launch("uridecodebin name=source force-sw-decoders=true "
                                "videoconvert name=before ! tee name=upright allow-not-linked=true "
                                "upright. ! queue ! videoflip video-direction=180 ! tee name=turned allow-not-linked=true")
    for name, filters in ("upright", upright), ("turned", turned):
        for each in filters:
            branch = [Gst.ElementFactory.make("queue"), each, Gst.ElementFactory.make("fakesink")]
            branch[0].set_property("max-size-buffers", 4)
            for element in branch:
                pipeline.add(element)
            for one, next_ in zip([pipeline.get_by_name(name), *branch], branch):
                one.link(next_)
    sink = pipeline.get_by_name("before").get_static_pad("sink")
    source = pipeline.get_by_name("source")
    source.set_property("uri", uri_of(clip))

    def link(_, pad):
        if pad.query_caps(None).to_string().startswith("video/x-raw") and not sink.is_linked():
            pad.link(sink)

    source.connect("pad-added", link)
    pipeline.set_state(Gst.State.PLAYING)
    try:
        while not (message := pipeline.bus.timed_pop_filtered(200 * Gst.MSECOND,
                                                              Gst.MessageType.EOS | Gst.MessageType.ERROR)):
            (_, at_ns), (_, all_ns) = (query(Gst.Format.TIME) for query in (pipeline.query_position, pipeline.query_duration))
            if all_ns > 0:
                tell(min(100 * at_ns // all_ns, 99))
        if message.type == Gst.MessageType.ERROR:
            raise RuntimeError(f"{clip} could not be played: {message.parse_error()[0].message}")
    finally:
        pipeline.set_state(Gst.State.NULL)


class TickRecorder:
    """Keeps the haptic trace while a clip plays. It comes through a pipe, as most of a session is not worth keeping.
    `streams`: takes each row, also of the time between clips (examples/lsl.py)."""

    def __init__(self, streams=None):
        self.streams = streams
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "ticks")
        os.mkfifo(self.path)
        self.pipe = os.open(self.path, os.O_RDONLY | os.O_NONBLOCK)
        fcntl.fcntl(self.pipe, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        self.header = self.rest = b""
        self.file, self.last_ns, self.device = None, 0, b""
        self.is_closed = False
        self.changed = threading.Condition()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.is_closed:
            if not select.select([self.pipe], [], [], 0.1)[0]:
                continue
            data = os.read(self.pipe, 1 << 16)
            if not data:  # nobody has opened it for writing
                time.sleep(0.02)
                continue
            *lines, self.rest = (self.rest + data).split(b"\n")
            with self.changed:
                if lines and not self.header:
                    self.header = lines.pop(0)
                    self.changed.notify_all()
                if lines:
                    if self.file:
                        self.file.write(b"".join(line + b"\n" for line in lines))
                    row = lines[-1].split(b",")
                    self.last_ns, self.device = int(row[1]), row[self.header.split(b",").index(b"device")]
                    self.changed.notify_all()
            for line in lines if self.streams else ():
                self.streams.add(dict(zip(self.header.decode().split(","), line.decode().split(","))))

    def start(self, path):
        """When the device gives what it is asked for: its strings become taut over some tenths of a second."""
        with self.changed:
            self.changed.wait_for(lambda: self.device == b"running", OPENING_S)
            self.file = open(path, "wb")
            self.file.write(self.header + b"\n")

    def stop(self):
        """When the rows until now are in the file, or do not come."""
        now_ns = time.monotonic_ns()
        with self.changed:
            self.changed.wait_for(lambda: self.last_ns >= now_ns, TRACE_LATE_S)
            self.file.close()
            self.file = None

    def close(self):
        self.is_closed = True
        self.thread.join()
        os.close(self.pipe)
        self.folder.cleanup()


class Player:
    """A context manager: the device is opened at its beginning and closed at its end.

    The position of the grip is counted from where it was when the device was opened, unless the profile is calibrated.
    Therefore one opening serves all clips. `output`: one of SINKS. `streams`: of TickRecorder.
    """

    def __init__(self, properties, output, streams=None):
        self.output, self.recorder, self.streams = output, None, streams
        self.filter = make_filter([*properties, "on-device-error=error"])
        self.filter.set_locked_state(True)  # it outlives the pipelines that it is in
        self.bus = Gst.Bus()
        self.pipeline = None

    def property(self, name):
        return self.filter.get_property(name)

    def __enter__(self):
        """Raises RuntimeError if the device cannot be opened."""
        if self.property("device") != "none":
            self.recorder = TickRecorder(self.streams)
            self.filter.set_property("haptic-trace", self.recorder.path)
        self.filter.set_bus(self.bus)
        if self.filter.set_state(Gst.State.READY) == Gst.StateChangeReturn.FAILURE:
            message = self.bus.pop_filtered(Gst.MessageType.ERROR)
            reason = message.parse_error()[0].message if message else "examples/play.sh says why"
            self.__exit__()
            raise RuntimeError(f"the device {self.property('device')} cannot be opened: {reason}")
        return self

    def __exit__(self, *_):
        self.close_clip()
        self.filter.set_state(Gst.State.NULL)
        self.filter.set_bus(None)
        if self.recorder:
            self.recorder.close()
            self.recorder = None

    def open_clip(self, clip, is_turned):
        """The picture is turned before it is analysed, and back: so is the force."""
        turn = "180" if is_turned else "identity"
        self.pipeline = Gst.parse_launch(
            "uridecodebin name=source force-sw-decoders=true "
            f"videoconvert name=before ! videoflip video-direction={turn} name=turned "
            f"videoflip video-direction={turn} name=back ! videoconvert ! videoscale ! {AHEAD} name=ahead ! {SINKS[self.output]}")
        get = self.pipeline.get_by_name
        self.screen = Screen(get("ahead").get_static_pad("src"))
        self.full_screen = FullScreen(self.pipeline) if self.output == "window" else None
        self.pipeline.add(self.filter)
        get("turned").link(self.filter)
        self.filter.link(get("back"))

        def link(_, pad):
            kind = pad.query_caps(None).to_string()
            if kind.startswith("video/x-raw") and not get("before").get_static_pad("sink").is_linked():
                pad.link(get("before").get_static_pad("sink"))
            if not kind.startswith("audio/x-raw"):
                return
            sound = Gst.parse_bin_from_description(f"queue ! audioconvert ! audioresample ! {SOUNDS[self.output]}", True)
            self.pipeline.add(sound)
            sound.sync_state_with_parent()
            pad.link(sound.get_static_pad("sink"))

        get("source").set_property("uri", uri_of(clip))
        get("source").connect("pad-added", link)
        self.filter.set_locked_state(False)

    def close_clip(self):
        if not self.pipeline:
            return
        self.filter.set_locked_state(True)
        self.pipeline.set_state(Gst.State.NULL)
        self.filter.set_state(Gst.State.READY)
        self.pipeline.remove(self.filter)
        if self.full_screen:
            self.full_screen.close()
        self.pipeline = None

    def play(self, clip, properties, is_turned=False, haptic_trace=None, screen_trace=None):
        """Plays to the end; returns False if the window was closed. Raises RuntimeError.

        `properties`: name=value, of this clip on.
        """
        for each in properties:
            Gst.util_set_object_arg(self.filter, *each.split("=", 1))
        self.open_clip(clip, is_turned)
        try:
            if haptic_trace:
                self.recorder.start(haptic_trace)
            self.pipeline.set_state(Gst.State.PLAYING)
            return self.wait(clip)
        finally:
            if haptic_trace:
                self.recorder.stop()
            if screen_trace:
                self.screen.write(screen_trace)
            self.close_clip()

    def wait(self, clip):
        while True:
            # Ctrl-C is noticed in between.
            message = self.pipeline.bus.timed_pop_filtered(100 * Gst.MSECOND,
                                                           Gst.MessageType.EOS | Gst.MessageType.ERROR)
            if message is None:
                continue
            if message.type == Gst.MessageType.EOS:
                return True
            error, _ = message.parse_error()
            is_sink = message.src.flags & int(Gst.ElementFlags.SINK)
            if is_sink and error.matches(Gst.resource_error_quark(), Gst.ResourceError.NOT_FOUND):
                return False
            raise RuntimeError(f"{clip} could not be played: {error.message}")
