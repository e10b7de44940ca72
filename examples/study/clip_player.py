# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a clip whose motion is felt, for study.py."""

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst  # noqa: E402

Gst.init(None)

FORCE_FILTERS = 1 << 11  # GstPlayFlags: frames in graphics memory would bypass the filter


def uri_of(clip):
    """Raises ValueError if there is no such file."""
    if Gst.uri_is_valid(clip):
        return clip
    try:
        with open(clip, "rb"):
            return Gst.filename_to_uri(clip)
    except OSError as error:
        raise ValueError(f"{clip}: {error.strerror}; give a video file or a URI") from error


def make_filter(properties):
    """spidarmotion with a list of name=value. Raises ValueError that says what is wrong."""
    try:
        return Gst.parse_launchv(["spidarmotion", *properties])
    except GLib.Error as error:
        if error.matches(Gst.parse_error_quark(), Gst.ParseError.NO_SUCH_ELEMENT):
            error.message += "; set GST_PLUGIN_PATH to the folder of its plugin, and write properties as name=value"
        raise ValueError(error.message) from error


class ClipPlayer:
    """A context manager: the device is closed at its end."""

    def __init__(self, clip, properties, headless):
        self.name = clip
        self.filter = make_filter(properties)
        self.player = Gst.ElementFactory.make("playbin")
        self.player.set_property("uri", uri_of(clip))
        self.player.set_property("video-filter", self.filter)
        self.player.set_property("flags", int(self.player.get_property("flags")) | FORCE_FILTERS)
        if headless:
            for sink in "video-sink", "audio-sink":
                self.player.set_property(sink, Gst.parse_launch("fakesink sync=true"))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.player.set_state(Gst.State.NULL)

    def pause(self):
        """The device is open, and its strings have their smallest tension. Raises RuntimeError."""
        self.player.set_state(Gst.State.PAUSED)
        if self.player.get_state(10 * Gst.SECOND)[0] == Gst.StateChangeReturn.FAILURE:
            raise RuntimeError(f"{self.name}: the device cannot be opened; examples/play.sh says why")

    def play(self):
        """Plays to the end; returns False if the window was closed. Raises RuntimeError."""
        self.player.set_state(Gst.State.PLAYING)
        while True:
            # Ctrl-C is noticed in between.
            message = self.player.bus.timed_pop_filtered(100 * Gst.MSECOND, Gst.MessageType.EOS | Gst.MessageType.ERROR)
            if message is None:
                continue
            if message.type == Gst.MessageType.EOS:
                return True
            error, _ = message.parse_error()
            is_sink = message.src.flags & int(Gst.ElementFlags.SINK)
            if is_sink and error.matches(Gst.resource_error_quark(), Gst.ResourceError.NOT_FOUND):
                return False
            raise RuntimeError(f"{self.name} could not be played: {error.message}")
