#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Drives a player through its standard input: check_player.py PROGRAM..."""
import os
import re
import subprocess
import sys
import tempfile
import wave

# Lines that are typed, and what is to be seen of the status after each.
TYPED = [
    (" \n", "paused"),
    ("<\n", "0.00 s"),
    (".\n", "0.04 s"),
    (".\n", "0.08 s"),
    ("l\n", "loop"),
    ("f\n", "force off"),
    ("d40\n", "delay 40 ms"),
    ("d\n", "delay 40 ms"),
    ("dx\n", "delay 40 ms"),
    ("+\n", "2x"),
    ("-\n", " 1x"),
    (" \n", "playing"),
    ("f\n", "force on"),
    ("q\n", ""),
]


def make_clip(folder, frames):
    """A ball at 25 frames/s; by a gst-launch-1.0 that does not see the plugin under test."""
    clip = os.path.join(folder, f"{frames}.avi")
    env = {k: v for k, v in os.environ.items() if not k.startswith("GST_PLUGIN_PATH")}
    env["GST_REGISTRY"] = os.path.join(folder, "registry.bin")
    subprocess.run(
        ["gst-launch-1.0", "-q", "videotestsrc", f"num-buffers={frames}", "pattern=ball", "!",
         "video/x-raw,width=320,height=240,framerate=25/1", "!", "jpegenc", "!", "avimux", "!",
         "filesink", f"location={clip}"], env=env, check=True)
    return clip


def make_sound(folder):
    file = os.path.join(folder, "sound.wav")
    with wave.open(file, "wb") as sound:
        sound.setparams((1, 2, 8000, 0, "NONE", ""))
        sound.writeframes(bytes(16000))
    return file


def bad_films(folder):
    """Names that no player can play, and what is said of them."""
    empty, text = (os.path.join(folder, name) for name in ("empty.avi", "text.avi"))
    for name, content in (empty, ""), (text, "no film\n" * 100):
        with open(name, "w") as file:
            file.write(content)
    return [(os.path.join(folder, "none.avi"), "[Nn]o such file|not found"), (folder, "folder|[Dd]irectory"),
            (empty, "empty|no data"), (text, "text file"), (make_sound(folder), "no video")]


def run(program, file, keys):
    done = subprocess.run([*program, "--headless", file], input=keys, text=True,
                          capture_output=True, timeout=60)
    return done.returncode, done.stdout.splitlines(), done.stderr


def check(program):
    with tempfile.TemporaryDirectory() as folder:
        code, lines, errors = run(program, make_clip(folder, 100), "".join(typed for typed, _ in TYPED))
        assert code == 0, errors
        expected = [text for _, text in TYPED]
        assert len(lines) >= len(expected), "\n".join(lines)
        for text, line in zip(expected, lines):
            assert re.search(r"[+-][0-9.]+ N right, [+-][0-9.]+ N up", line), line
            assert text in line, f"'{text}' is not in '{line}'\n" + "\n".join(lines)
        code, lines, _ = run(program, make_clip(folder, 10), "")  # to the end, without a key
        assert code == 0
        check_refused(program, folder)


def check_refused(program, folder):
    """What is no film is named, with what is wrong with it, and the player says so to its caller."""
    for name, reason in [*bad_films(folder), ("nothing://here", "No URI handler"), ("--unknown", "FILE-OR-URI"),
                         ("http://127.0.0.1:1/film.mp4", r"\(.+\)|refused")]:
        code, _, errors = run(program, name, "")
        assert code != 0, name
        assert re.search(reason, errors), errors
        assert name in errors or name.startswith("--"), errors
    done = subprocess.run(program, stdin=subprocess.DEVNULL, text=True, capture_output=True,
                          timeout=60)
    assert done.returncode != 0 and "FILE-OR-URI" in done.stderr, done


if __name__ == "__main__":
    check(sys.argv[1:])
