#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A window with a web page, by WebKitGTK: web_video.py URI. SIGUSR2 ends it. `--check` says what is missing,
if anything, and exits with 77 then."""

import signal
import sys

try:
    import gi

    gi.require_version("Gtk", "3.0")
    gi.require_version("WebKit2", "4.1")
    from gi.repository import GLib, Gtk, WebKit2
except (ImportError, ValueError) as error:
    print(f"no WebKitGTK for Python (packages python3-gi, gir1.2-webkit2-4.1): {error}")
    sys.exit(77)

if sys.argv[1] == "--check":
    sys.exit(0)

view = WebKit2.WebView()
view.load_uri(sys.argv[1])
window = Gtk.Window(title="web video", default_width=400, default_height=300)
window.add(view)
window.show_all()
GLib.unix_signal_add(GLib.PRIORITY_DEFAULT, signal.SIGUSR2, Gtk.main_quit)
Gtk.main()
