#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Drives a player through its standard input: check_players.py cpp|python PROGRAM..."""
import fcntl
import os
import pty
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import wave

# Keys, and what is to be seen of the status after each.
CPP = [
    (" ", "paused"),
    ("\033[D", "0:00.00 / 0:04.00"),
    (".", "0:00.04"),
    ("f", "force off"),
    ("d40\n", "delay 40 ms"),
    ("d-15\n", "delay -15 ms"),
    ("+", "1.5x"),
    ("-", " 1x"),
    ("l", "loop"),
    ("dx", "delay -15 ms"),
    ("f", "force on"),
    (" ", "playing"),
    ("\033[C", "playing"),
    ("q", ""),
]
PYTHON = [
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


# How a player may end, and its exit code.
ENDINGS = [
    (lambda main, player: os.write(main, b"q"), 0),
    (lambda main, player: player.send_signal(signal.SIGINT), 0),
    (lambda main, player: player.send_signal(signal.SIGTERM), 0),
    (lambda main, player: player.send_signal(signal.SIGHUP), 0),
    (lambda main, player: player.send_signal(signal.SIGQUIT), -signal.SIGQUIT),
    (lambda main, player: player.send_signal(signal.SIGABRT), -signal.SIGABRT),
    (lambda main, player: player.send_signal(signal.SIGSEGV), -signal.SIGSEGV),
    (lambda main, player: None, 0),  # the film ends
]


def start_on_terminal(program, file, terminal, output):
    # In a process group of its own: one that nobody waits for could not be stopped.
    return subprocess.Popen([*program, "--headless", file], stdin=terminal, stdout=output,
                            stderr=subprocess.STDOUT, preexec_fn=start_in_own_group)


def start_in_own_group():
    os.setpgrp()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def check_terminal(program, film, no_film):
    """The terminal is left as it was, however the player ends."""
    for number, (end_it, code) in enumerate(ENDINGS):
        main, terminal = pty.openpty()
        before = termios.tcgetattr(terminal)
        player = start_on_terminal(program, film, terminal, subprocess.PIPE)
        player.stdout.readline()  # it plays
        assert termios.tcgetattr(terminal) != before, "keys need a return"
        end_it(main, player)
        player.communicate(timeout=60)
        assert player.returncode == code, (number, player.returncode)
        assert termios.tcgetattr(terminal) == before, f"ending {number}: the terminal is not as before"
        os.close(main)
        os.close(terminal)
    main, terminal = pty.openpty()
    before = termios.tcgetattr(terminal)
    player = start_on_terminal(program, no_film, terminal, subprocess.PIPE)
    player.communicate(timeout=60)
    assert player.returncode == 1, player.returncode
    assert termios.tcgetattr(terminal) == before, "after an error the terminal is not as before"
    check_stop(program, film, main, terminal)


def check_stop(program, film, main, terminal):
    """Ctrl-Z gives the terminal back for as long as it lasts."""
    before = termios.tcgetattr(terminal)
    player = start_on_terminal(program, film, terminal, subprocess.PIPE)
    player.stdout.readline()
    player.send_signal(signal.SIGTSTP)
    _, status = os.waitpid(player.pid, os.WUNTRACED)
    assert os.WIFSTOPPED(status), status
    assert termios.tcgetattr(terminal) == before, "stopped, the terminal is not as before"
    player.send_signal(signal.SIGCONT)
    while termios.tcgetattr(terminal) == before:  # the test has a limit of its own
        time.sleep(0.01)
    os.write(main, b"q")
    player.communicate(timeout=60)
    assert termios.tcgetattr(terminal) == before
    os.close(main)
    os.close(terminal)


def check_screen(program, film):
    """Keys, status and the force as a bar stand on the terminal, and no line is too long for it."""
    for width in 100, 30:
        main, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
        player = start_on_terminal(program, film, terminal, terminal)
        os.close(terminal)
        text = b""
        try:
            while part := os.read(main, 65536):
                text += part
        except OSError:  # the other end is closed
            pass
        player.wait(timeout=60)
        os.close(main)
        assert player.returncode == 0, text
        text = text.decode()
        lines = [re.sub("\033\\[[0-9]*[A-Z]", "", line) for line in re.split("[\r\n]+", text)]
        assert any(line.startswith("space pause") for line in lines), text
        forces = [line for line in lines if line.startswith("force [")]
        assert forces and any("#" in line for line in forces), text
        assert max(map(len, lines)) < width, max(lines, key=len)
        if width == 100:
            assert re.search(r"force \[#+\.*\]  \d\.\d N  right [+-]\d\.\d", text), text


def run(program, file, keys):
    done = subprocess.run([*program, "--headless", file], input=keys, text=True,
                          capture_output=True, timeout=60)
    return done.returncode, done.stdout.splitlines(), done.stderr


def check(program, script, first):
    with tempfile.TemporaryDirectory() as folder:
        code, lines, errors = run(program, make_clip(folder, 100), "".join(keys for keys, _ in script))
        assert code == 0, errors
        expected = [text for _, text in script if text is not None]
        seen = lines[first:]
        assert len(seen) >= len(expected), "\n".join(lines)
        for text, line in zip(expected, seen):
            assert text in line, f"'{text}' is not in '{line}'\n" + "\n".join(lines)
        code, lines, _ = run(program, make_clip(folder, 10), "")  # to the end, without a key
        assert code == 0
        check_refused(program, folder)
        if sys.argv[1] == "cpp":
            film = make_clip(folder, 50)
            check_terminal(program, film, make_sound(folder))
            check_screen(program, film)


def check_refused(program, folder):
    """What is no film is named, with what is wrong with it, and the player says so to its caller."""
    empty, text = (os.path.join(folder, name) for name in ("empty.avi", "text.avi"))
    for name, content in (empty, ""), (text, "no film\n" * 100):
        with open(name, "w") as file:
            file.write(content)
    for name, reason in [(os.path.join(folder, "none.avi"), "no such file|not found"),
                         (folder, "folder|directory"), (empty, "empty|no data"),
                         (text, "text file"), ("nothing://here", "No URI handler"),
                         ("--unknown", "FILE-OR-URI"), (make_sound(folder), "no video"),
                         ("http://127.0.0.1:1/film.mp4", r"\(.+\)|refused")]:
        code, _, errors = run(program, name, "")
        assert code != 0, name
        assert re.search(reason, errors), errors
        assert name in errors or name.startswith("--"), errors
    done = subprocess.run(program, stdin=subprocess.DEVNULL, text=True, capture_output=True,
                          timeout=60)
    assert done.returncode != 0 and "FILE-OR-URI" in done.stderr, done


if __name__ == "__main__":
    check(sys.argv[2:], CPP if sys.argv[1] == "cpp" else PYTHON, 1 if sys.argv[1] == "cpp" else 0)
