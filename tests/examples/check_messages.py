#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Runs the examples that use messages when their frames are shown: check_messages.py EXAMPLES

No frame is shown before its running time, all of them are shown, and the window of GTK has them, too.
"""
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

from check_player import make_clip

FRAMES, INTERVAL_S = 40, 1 / 25


def check_terminal(examples, film):
    done = subprocess.run([sys.executable, examples / "motion_messages.py", "--headless", film], text=True,
                          capture_output=True, timeout=60)
    assert done.returncode == 0 and not done.stderr, done
    shown = [[float(number) for number in re.findall(r"[-+]?\d+\.\d+", line)] for line in done.stdout.splitlines()]
    times = [frame_s for _, frame_s, _, _ in shown]
    assert times == sorted(times) and len(times) >= FRAMES - 2, done.stdout  # the end comes before the last one is due
    # Printed with three digits.
    assert all(now_s > frame_s - 0.001 for now_s, frame_s, _, _ in shown), done.stdout
    # A message is there a queue's length before: some would be too early by far if they were not kept.
    assert any(abs(right) + abs(up) > 0.5 for _, _, right, up in shown), done.stdout


def check_error(examples):
    done = subprocess.run([sys.executable, examples / "motion_messages.py", "--headless", "/nowhere.avi"], text=True,
                          capture_output=True, timeout=60)
    assert done.returncode == 1 and "/nowhere.avi" in done.stderr and "Traceback" not in done.stderr, done


def check_gtk(examples, film):
    """In this process, which has the display of a server of its own."""
    import gi

    try:
        gi.require_version("Gtk", "4.0")
    except ValueError:
        print("skipped: gir1.2-gtk-4.0 is not installed", file=sys.stderr)
        sys.exit(77)
    from gi.repository import Gtk

    seen = []
    show = Gtk.Label.set_markup
    Gtk.Label.set_markup = lambda label, markup: (seen.append(markup), show(label, markup))
    sys.argv = ["gtk_arrow.py", film]
    runpy.run_path(str(examples / "gtk_arrow.py"), run_name="__main__")
    arrows = {re.search(">(.)<", markup).group(1) for markup in seen}
    assert len(arrows) > 1, seen  # the ball goes round, and not every frame is drawn on a busy machine


def start_screen():
    reader, writer = os.pipe()
    server = subprocess.Popen(["Xvfb", "-noreset", "-displayfd", str(writer), "-screen", "0", "800x600x24"],
                              pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    os.environ["DISPLAY"] = ":" + os.fdopen(reader).readline().strip()
    os.environ |= {"GDK_BACKEND": "x11", "GSK_RENDERER": "cairo"}
    os.environ.pop("WAYLAND_DISPLAY", None)
    return server


def main():
    examples = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        film = make_clip(folder, FRAMES)
        check_terminal(examples, film)
        check_error(examples)
        if not shutil.which("Xvfb"):
            print("skipped: Xvfb is not installed", file=sys.stderr)
            sys.exit(77)
        server = start_screen()
        hangs = threading.Timer(60, server.kill)  # without its display, GTK ends the program
        hangs.start()
        try:
            check_gtk(examples, film)
        finally:
            hangs.cancel()
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
