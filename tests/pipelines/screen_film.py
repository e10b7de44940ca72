#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A plain window with a moving picture, without a player: screen_film.py TITLE LINE, a launch line of a source."""

import sys

import gi

gi.require_version("Gst", "1.0")
from gi.repository import GLib, Gst

GLib.set_prgname("screen_film")
GLib.set_application_name(sys.argv[1])  # ximagesink's title
Gst.init(None)
pipeline = Gst.parse_launch(sys.argv[2] + " ! videoconvert ! ximagesink handle-events=false")
pipeline.set_state(Gst.State.PLAYING)
GLib.MainLoop().run()
