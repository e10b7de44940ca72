#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Runs the command lines of README.md, CONTRIBUTING.md, tests/README.md and docs/.

check_commands.py SOURCE BUILD: the code blocks of each page are run in their order, line by line in a shell, as by
somebody who reads it: in one folder that looks like SOURCE with BUILD as build/, and has a short film under the names
that the pages use. What else a line reads, one before it has written. A line runs where the page has led: in the folder
of the shell that `meson devenv` opens, or of `cd`. All lines must exit with status 0, on a virtual screen, without
installed profiles or plugins.

An HTML comment before a block states exceptions for the whole block or, with parentheses, for lines that contain
the given text:

    <!-- not run: REASON -->             needs hardware, root, minutes, or a person
    <!-- not run (TEXT): REASON -->
    <!-- endless -->                     runs until it is interrupted
    <!-- endless (TEXT) -->
    <!-- not commands -->                a formula, or a program

A line with <<'END' goes on to the line END. What is not run is listed with its reason."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

PYTHON = "/usr/bin/python3"
FILMS = ("film.mp4", "vtest.avi", "ball.avi", "telephone.mp4")
OPTIONAL = {"ffmpeg": "ffmpeg", "mkvmerge": "mkvtoolnix"}  # programs that lines need, and who has them
ELEMENTS = ("sdpdemux", "srtsink", "srtsrc")  # of gstreamer1.0-plugins-bad, as optional
# What a program inside a line needs, a command that says whether it is there, and who has it.
INSIDE = {
    "webrtc.py": (["gst-inspect-1.0", "nicesrc"], "gstreamer1.0-nice"),
    "editing.py": ([PYTHON, "-c", "import gi; gi.require_version('GES', '1.0')"], "gir1.2-ges-1.0"),
    **dict.fromkeys(("appsrc.py", "forces.py"),
                    ([PYTHON, "-c", "import gi; gi.require_version('Gst', '1.0')"], "gir1.2-gstreamer-1.0")),
}
ENCODERS = ("x264enc", "openh264enc")  # one of which spidartrack needs to make a film
WORKERS = 2
LONGEST_S = 60  # of a line that ends, and of one that was interrupted; the test has a limit of its own
ENDLESS_S = 2
SKIPPED = 77
NETWORK = re.compile(r"\b(srt|tcp|udp|sdp)\w* ")
# A shell, not a command in it; it opens in the build folder unless another is named (-w).
SHELL = re.compile(r"meson devenv -C (\S+?)(?: -w (\S+?))?(?:`|$|\s+#)")
COMMENT = re.compile(r"<!-- (not run|endless|not commands)(?: \((.*?)\))?(?:: (.*?))? -->$")


@dataclass
class Line:
    where: str
    command: str
    exports: list  # of this and the blocks before it
    folder: str
    endless: bool = False
    not_run: str = ""


def blocks(text):
    """(line number, comments before it, lines) of each block of code that is indented; of what leads into a shell
    elsewhere, the same without comments."""
    lines = text.split("\n")
    comments, i = [], 0
    while i < len(lines):
        if match := COMMENT.match(lines[i]):
            comments.append(match.groups())
        elif lines[i].startswith("<!-- ") and any(word in lines[i] for word in ("run", "endless", "commands")):
            sys.exit(f"error: not understood: {lines[i]}")
        elif lines[i].startswith("    ") and i > 0 and not lines[i - 1]:
            begin = i
            while i < len(lines) and (lines[i].startswith("    ") or not lines[i]):
                i += 1
            yield begin + 1, comments, [line[4:] for line in lines[begin:i] if line]
            comments = []
            continue
        elif lines[i]:
            comments = []
            if SHELL.search(lines[i]):
                yield i + 1, None, [lines[i]]
        i += 1


def commands(page, source):
    exports, folder = [], "."
    for number, comments, lines in blocks((source / page).read_text(encoding="utf-8")):
        for shell in map(SHELL.search, lines):
            if shell:
                folder = shell.group(2) or shell.group(1)
        if comments is None:
            continue
        if any(kind == "not commands" for kind, _, _ in comments):
            continue
        whole = not_run_of(comments, None)
        if whole:
            for offset, line in enumerate(lines):
                if offset == 0 or not lines[offset - 1].endswith("\\"):
                    yield Line(f"{page}:{number + offset}", line, [], folder, not_run=whole)
            continue
        command, begin = "", number
        for offset, line in enumerate(lines):
            begin = begin if command else number + offset
            command += line
            if line.endswith("\\") or ("<<'END'" in command and line != "END"):
                command += "\n"
                continue
            if command.startswith("export "):
                exports.append(command)
            elif command.startswith("cd "):
                folder = os.path.join(folder, command[3:])
            else:
                endless = any(kind == "endless" and (text is None or text in command) for kind, text, _ in comments)
                not_run = not_run_of(comments, command) or missing_program(command)
                yield Line(f"{page}:{begin}", command, list(exports), folder, endless, not_run)
            command = ""


def not_run_of(comments, command):
    """The reason; of the whole block when `command` is None."""
    for kind, text, reason in comments:
        if kind == "not run" and (text is None if command is None else text is not None and text in command):
            return reason
    return ""


def missing_program(command):
    """Why a line that needs an optional program or element is skipped; empty when it is there."""
    for element in ELEMENTS:
        if f" {element} " in command and subprocess.run(["gst-inspect-1.0", "--exists", element]).returncode:
            return f"skipped: the element {element} is not installed (package gstreamer1.0-plugins-bad)"
    if re.search(r"spidartrack (show|export .*(/|--embed)$)", command) and all(
            subprocess.run(["gst-inspect-1.0", "--exists", element]).returncode for element in ENCODERS):
        return f"skipped: none of {', '.join(ENCODERS)} is installed"
    for word, (asks, owner) in INSIDE.items():
        if word in command and subprocess.run(asks, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            return f"skipped: {owner} is not installed"
    for program, owner in OPTIONAL.items():
        if re.search(rf"(^|[|;&] *){program} ", command) and not shutil.which(program):
            return f"skipped: {owner} is not installed"
    return ""


def make_film(folder):
    """Half a second of a moving ball, without sound: not every machine has a sound card."""
    film = folder / FILMS[0]
    subprocess.run(
        f"gst-launch-1.0 -q videotestsrc num-buffers=15 pattern=ball ! video/x-raw,width=320,height=240 "
        f"! jpegenc ! avimux ! filesink location={film}",
        shell=True,
        check=True,
    )
    for name in FILMS[1:]:
        shutil.copy(film, folder / name)


def make_folder(folder, films, source, build):
    for film in FILMS:
        (folder / film).symlink_to(films / film)
    for entry in source.iterdir():
        if entry.name not in ("docs", "build") and not entry.name.startswith("."):
            (folder / entry.name).symlink_to(entry)
    (folder / "docs" / "figures").mkdir(parents=True)
    (folder / "build").symlink_to(build)


def run(line, folder):
    """What is wrong, or an empty text. The page began in `folder`."""
    text = re.sub(r"file:///\w+/", f"file://{folder}/", line.command)
    script = "\n".join(["set -eo pipefail", *line.exports, text])
    process = subprocess.Popen(
        ["bash", "-c", script],
        cwd=folder / line.folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    try:
        said, _ = process.communicate(timeout=ENDLESS_S if line.endless else LONGEST_S)
        early = "ended by itself\n" if line.endless else ""
    except subprocess.TimeoutExpired:
        early = "" if line.endless else f"did not end within {LONGEST_S} s\n"
        os.killpg(process.pid, signal.SIGINT)
        try:
            said, _ = process.communicate(timeout=LONGEST_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            said, _ = process.communicate()
            early += "did not end when it was interrupted\n"
    status = process.returncode
    if line.endless and status in (-signal.SIGINT, 128 + signal.SIGINT):
        status = 0
    if status != 0:
        early += f"exit status {status}\n"
    if "CRITICAL" in said:
        early += "says CRITICAL\n"
    if "nothing says that it is a haptic track" in said:
        early += "plays a track that is not marked\n"
    return early and early + said


class Screen:
    """A virtual one, for as long as this lives."""

    def __init__(self):
        ours, its = os.pipe()
        self.server = subprocess.Popen(
            # Without -noreset a server whose last window closes is away for a moment.
            ["Xvfb", "-noreset", "-displayfd", str(its), "-screen", "0", "1280x800x24"],
            pass_fds=[its],
            stderr=subprocess.DEVNULL,
        )
        os.close(its)
        with os.fdopen(ours) as number:
            os.environ["DISPLAY"] = ":" + number.readline().strip()
        os.environ.pop("WAYLAND_DISPLAY", None)

    def end(self):
        self.server.terminate()
        self.server.wait()


def main():
    source, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    if not shutil.which("Xvfb"):
        print("skipped: Xvfb is not installed (package xvfb)")
        return SKIPPED
    screen = Screen()
    os.environ.pop("SPIDAR_PROFILE_PATH", None)
    # If no other sink opens on a busy machine, autovideosink tries DirectFB, whose library then crashes in a thread of
    # its own (libfusion 1.7).
    os.environ["GST_PLUGIN_FEATURE_RANK"] = "dfbvideosink:NONE"
    os.environ["GST_PLUGIN_PATH"] = str(build / "plugin")
    os.environ["PATH"] = f"{build / 'spidar' / 'tools'}:{build / 'plugin'}:{os.environ['PATH']}"

    pages = ["README.md", "CONTRIBUTING.md", "tests/README.md"]
    pages += sorted(str(page.relative_to(source)) for page in (source / "docs").rglob("*.md"))
    lines = [list(commands(page, source)) for page in pages]
    failed = ran = 0
    with tempfile.TemporaryDirectory() as films:
        os.environ["GST_REGISTRY"] = f"{films}/registry.bin"
        make_film(Path(films))
        with ThreadPoolExecutor(WORKERS) as pool:
            # Two lines with the same port would meet: the second of them begins when the first has ended.
            on_network = threading.Lock()

            def run_page(page):
                """(line, what is wrong with it) of those that run."""
                results = []
                with tempfile.TemporaryDirectory() as name:
                    make_folder(Path(name), Path(films), source, build)
                    for line in page:
                        if not line.not_run:
                            with on_network if NETWORK.search(line.command) else nullcontext():
                                results.append((line, run(line, Path(name))))
                return results

            for results in pool.map(run_page, lines):
                for line, wrong in results:
                    ran += 1
                    print(f"{'FAILED' if wrong else 'ok'}: {line.where}: {line.command}", flush=True)
                    if wrong:
                        failed += 1
                        print(wrong)
    screen.end()
    not_run = [line for page in lines for line in page if line.not_run]
    for line in not_run:
        print(f"not run: {line.where}: {line.command.strip()}: {line.not_run}")
    print(f"{ran} run, {failed} failed, {len(not_run)} not run")
    return 1 if failed or not ran else 0


if __name__ == "__main__":
    sys.exit(main())
