#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Checks that programs report what is wrong with the name of a film, and exit: check_films.py PROGRAM..."""
import os
import re
import struct
import subprocess
import sys
import tempfile
import wave

from check_player import bad_films


def check(program, name, reason):
    done = subprocess.run([*program, name], stdin=subprocess.DEVNULL, text=True, capture_output=True,
                          timeout=60)
    assert done.returncode in (1, 2), (program, name, done)
    assert re.search(reason, done.stderr), (program, name, done.stderr)
    assert name in done.stderr or os.path.basename(name) in done.stderr, (program, name, done.stderr)


def check_output(play, folder):
    """Refused before the film is played."""
    for output in "/dev/null/folder", "/proc/none":
        done = subprocess.run([play, "--headless", "--ball", "--output", output], text=True,
                              capture_output=True, timeout=60)
        assert done.returncode == 2 and output in done.stderr, done
        assert "playing" not in done.stdout, done.stdout
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "spidar-play.png")
        with open(picture, "w", encoding="utf-8") as file:
            file.write("mine")
        done = subprocess.run([play, "--headless", "--ball", "--output", folder], text=True, capture_output=True, timeout=60)
        assert done.returncode != 0 and "nothing says that play.sh has made it" in done.stderr, done
        assert "playing" not in done.stdout and os.path.getsize(picture) == 4, done


def check_properties(play):
    """Names without values, and properties without dashes."""
    for words, said in ((["--ball", "--", "motion", "camera"], "motion=VALUE, where VALUE is one of mean, object, objects, camera"),
                        (["--ball", "--", "alpha"], "alpha=VALUE, where VALUE is a number from 1e-06 to 10"),
                        (["--ball", "--", "camera"], "camera: is not PROPERTY=VALUE"),
                        (["--ball", "motion=camera"], "properties follow --: play VIDEO -- motion=camera"),
                        (["film.mp4", "motion=camera"], "properties follow --: play VIDEO -- motion=camera")):
        done = subprocess.run([play, "--headless", *words], text=True, capture_output=True, timeout=60)
        assert done.returncode == 2 and said in done.stderr, done


def check_track(play, folder):
    """Frames whose force is that of a track are played."""
    track = os.path.join(folder, "ball.wav")
    with wave.open(track, "wb") as file:
        file.setnchannels(6)
        file.setsampwidth(2)
        file.setframerate(1000)
        file.writeframes(struct.pack("<6h", 4000, 0, 0, 0, 0, 0) * 10000)  # 1.2 N for 10 s
    done = subprocess.run([play, "--headless", "--ball", "--seconds", "2", "--output", folder, "--", "device=sim",
                           f"track={track}"], text=True, capture_output=True, timeout=60)
    assert done.returncode == 0 and "warning: " not in done.stderr, done
    assert "playing ball.wav" in done.stdout, done.stdout
    # "late" on a busy machine.
    assert re.search(r"^ +[\d.]+ s +1\.22 N \[=+ +\] x \+1\.22 y \+0\.00  (felt|late)$", done.stdout, re.M), done.stdout
    assert "Analysis: none, because the force is that of the haptic track ball.wav." in done.stdout, done.stdout
    assert "Felt: " in done.stdout, done.stdout
    assert os.path.getsize(os.path.join(folder, "spidar-play.png")) > 0


def check_window_png(play, folder):
    """A film that is shorter than the plots of the window ends with a word about the picture."""
    picture = os.path.join(folder, "window.png")
    screenless = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([play, "--headless", "--ball", "--seconds", "1", "--output", folder, "--window-png", picture,
                           "--", "device=none"], text=True, capture_output=True, timeout=60, env=screenless)
    assert f"{picture}: could not be saved" in done.stdout, done


def main():
    with tempfile.TemporaryDirectory() as folder:
        for program in sys.argv[1:]:
            command = [program, "--headless"] if os.path.basename(program) == "play" else [program]
            for name, reason in [*bad_films(folder), ("http://127.0.0.1:1/film.mp4", "127.0.0.1.*does its host answer")]:
                check(command, name, reason)
            if os.path.basename(program) == "play":
                check_properties(program)
                check_output(program, folder)
                check_track(program, folder)
                check_window_png(program, folder)


if __name__ == "__main__":
    main()
