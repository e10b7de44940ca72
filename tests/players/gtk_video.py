#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A player of GTK 4's own widget: gtk_video.py FILM. SIGUSR1 pauses it or lets it play, SIGUSR2 ends it.
`--check` says what is missing, if anything, and exits with 77 then."""

import signal
import sys

try:
    import gi

    gi.require_version("Gtk", "4.0")
    from gi.repository import GLib, Gtk
except (ImportError, ValueError) as error:
    print(f"no GTK 4 for Python (packages python3-gi, gir1.2-gtk-4.0): {error}")
    sys.exit(77)

if sys.argv[1] == "--check":
    Gtk.init_check()
    if Gtk.MediaFile.new().__gtype__.name == "GtkNoMediaFile":
        print("GTK 4 plays no films (package libgtk-4-media-gstreamer)")
        sys.exit(77)
    sys.exit(0)


def play_or_pause():
    stream = video.get_media_stream()
    stream.set_playing(not stream.get_playing())
    return True


loop = GLib.MainLoop()
video = Gtk.Video.new_for_filename(sys.argv[1])
video.set_autoplay(True)
Gtk.Window(title="GtkVideo", child=video, default_width=320, default_height=240).present()
GLib.unix_signal_add(GLib.PRIORITY_DEFAULT, signal.SIGUSR1, play_or_pause)
GLib.unix_signal_add(GLib.PRIORITY_DEFAULT, signal.SIGUSR2, loop.quit)
loop.run()
