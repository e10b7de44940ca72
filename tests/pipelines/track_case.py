# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""For tests of spidartrack as on the command line: a folder, films and tracks in it, and the command.
The environment names the program (SPIDARTRACK)."""
import array
import math
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["SPIDARTRACK"]
CHANNELS = ("fx", "fy", "fz", "tx", "ty", "tz")
FULL_SCALE = (10, 10, 10, 1, 1, 1)  # N, N m


def wave(ms):
    """A sample of six different channels, as shares of the full scale."""
    share = .15 * math.sin(.01 * ms)
    return (share, -share / 2, share / 3, share / 100, share / 70, -share / 50)


def chunk(name, content):
    """Of a RIFF file."""
    return name + struct.pack("<I", len(content)) + content + b"\0" * (len(content) % 2)


# A comment that says that it is a haptic track.
MARK = chunk(b"LIST", b"INFO" + chunk(b"ICMT", b"HAPTIC_FULL_SCALE=10 N, 1 N m\0"))


def write_wav(path, samples, rate=1000, marked=True):
    """Samples of any number of channels as a WAV file of floats."""
    channels = len(samples[0])
    data = array.array("f", [value for sample in samples for value in sample]).tobytes()
    form = struct.pack("<HHIIHH", 3, channels, rate, 4 * channels * rate, 4 * channels, 32)
    chunks = b"WAVE" + chunk(b"fmt ", form) + (MARK if marked else b"") + chunk(b"data", data)
    pathlib.Path(path).write_bytes(chunk(b"RIFF", chunks))


def read_wav(path):
    """The samples of a WAV file of floats, one tuple each, and their rate in Hz."""
    content = pathlib.Path(path).read_bytes()
    at, channels, rate = 12, 0, 0
    while at < len(content):
        name, length = content[at:at + 4], struct.unpack("<I", content[at + 4:at + 8])[0]
        if name == b"fmt ":
            kind, channels, rate = struct.unpack("<HHI", content[at + 8:at + 16])
            assert kind in (3, 0xfffe), f"{path}: not of floats"
        if name == b"data":
            values = array.array("f", content[at + 8:at + 8 + length])
            return list(zip(*[iter(values)] * channels)), rate
        at += 8 + length + length % 2
    raise AssertionError(f"{path}: no samples")


def part_name(name):
    """What the file `name` is called while it is being written (spidar/part_file.h)."""
    number = 0xcbf29ce484222325  # FNV-1a
    for byte in os.fsencode(name):
        number = (number ^ byte) * 0x100000001b3 % 2**64
    return f".part-{number:016x}{pathlib.PurePath(name).suffix}"


def tries():
    """For what a busy machine may leave out: again and again for a minute, and three times at least."""
    until_s = time.monotonic() + 60
    count = 0
    while count < 3 or time.monotonic() < until_s:
        count += 1
        yield count


class TrackCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="spidartrack-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, name):
        return self.folder / name

    def run_in_folder(self, command, status=0, **options):
        """Runs a command line, a list or a text for the shell, in the folder, and returns what it has
        printed, both outputs. A status of None may be any."""
        run = subprocess.run(command, shell=isinstance(command, (str, bytes)), cwd=self.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                             executable="/bin/bash" if isinstance(command, (str, bytes)) else None,
                             check=False, **options)
        text = run.stdout.decode(errors="replace")
        self.status = run.returncode
        if status is not None:
            self.assertEqual(run.returncode, status, f"{command}\n{text}")
        return text

    def spidartrack(self, *arguments, status=0, **options):
        return self.run_in_folder([PROGRAM, *arguments], status, **options)

    def assert_said(self, part, *arguments, status=1, **options):
        """Of a command that fails, and says why."""
        self.assertIn(part, self.spidartrack(*arguments, status=status, **options))

    def gst(self, *elements):
        self.run_in_folder(["gst-launch-1.0", "-q", *" ".join(elements).split()])

    def make_film(self, name="film.avi", frames=25, pattern="ball"):
        """25 frames a second."""
        self.path(name).parent.mkdir(parents=True, exist_ok=True)
        self.gst(f"videotestsrc num-buffers={frames} pattern={pattern} horizontal-speed=3",
                 "! video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! avimux",
                 "! filesink location=made.film")
        self.path("made.film").rename(self.path(name))

    def make_track(self, name="a.wav", count=1000, sample=wave):
        write_wav(self.path(name), [sample(ms) for ms in range(count)])

    def samples(self, name):
        """Of a track of any format."""
        if not str(name).endswith(".wav"):
            self.spidartrack("convert", name, "read back.wav")
            name = "read back.wav"
        return read_wav(self.path(name))[0]

    def files(self):
        return {str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if not path.is_dir()}


def needs(*programs):
    missing = [name for name in programs if not shutil.which(name)]
    return unittest.skipIf(missing, f"needs {', '.join(missing)}")
