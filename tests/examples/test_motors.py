#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""examples/motors.py: its messages, and a film that is sent to a socket, a pipe and a serial line.

    test_motors.py EXAMPLES
"""

import os
import pty
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

EXAMPLES = Path(sys.argv.pop(1) if len(sys.argv) > 1 else "examples")
sys.path.insert(0, str(EXAMPLES))

import motors  # noqa: E402


class Messages(unittest.TestCase):
    def test_osc_is_as_its_specification_has_it(self):
        self.assertEqual(motors.osc_message([0.5, -1]), b"/spidar\0,ff\0" + struct.pack(">ff", 0.5, -1))
        for count in range(1, 7):
            self.assertEqual(len(motors.osc_message([0] * count)) % 4, 0)

    def test_midi_fills_its_range_and_rests_in_the_middle(self):
        self.assertEqual(motors.midi_message([-1, 0, 1], 16, 1), bytes([0xB0, 16, 0, 0xB0, 17, 64, 0xB0, 18, 127]))
        self.assertEqual(motors.midi_message([0], 1, 16)[0], 0xBF)

    def test_tcode_fills_its_range(self):
        self.assertEqual(motors.tcode_message([-1, 1], ["fy", "tz"], 10), b"L00000I10 R19999I10\n")
        self.assertEqual(motors.tcode_message([0], ["fy"], 10), b"L05000I10\n")


class Film(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.film = cls.folder / "ball.avi"
        subprocess.run(["gst-launch-1.0", "-q", "videotestsrc", "pattern=ball", "num-buffers=50", "!",
                        "video/x-raw,width=320,height=240,framerate=25/1", "!", "jpegenc", "!", "avimux", "!", "filesink",
                        f"location={cls.film}"], check=True)

    def start(self, *arguments):
        program = subprocess.Popen([sys.executable, EXAMPLES / "motors.py", "--headless", self.film, *arguments],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(program.kill)
        self.addCleanup(program.stdout.close)
        self.addCleanup(program.stderr.close)
        return program

    def read(self, file, into):
        """A thread that reads until the other end is closed."""
        def run():
            try:
                while part := os.read(file, 65536):
                    into.append(part)
            except OSError:
                pass  # of a terminal, that is its end
        thread = threading.Thread(target=run)
        thread.start()
        return thread

    def test_osc_has_the_force_and_ends_at_rest(self):
        inlet = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(inlet.close)
        inlet.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        inlet.bind(("127.0.0.1", 0))
        program = self.start(f"osc:127.0.0.1:{inlet.getsockname()[1]}", "--axes", "fx,fy")
        said, errors = program.communicate(timeout=60)
        self.assertEqual((program.returncode, errors), (0, ""))
        inlet.setblocking(False)
        values = []
        try:
            while True:
                values.append(struct.unpack(">ff", inlet.recv(64)[-8:]))
        except BlockingIOError:
            pass
        self.assertIn(f"{len(values)} messages sent to osc:", said)
        self.assertEqual(values[-1], (0, 0))
        # A hand feels 0.04 N, of the full 3 N.
        self.assertGreater(max(max(map(abs, value)) for value in values), 0.04 / 3)
        self.assertTrue(all(-1 <= each <= 1 for value in values for each in value))

    def test_midi_ends_at_rest(self):
        pipe = self.folder / "midi"
        os.mkfifo(pipe)
        program = self.start(f"midi:{pipe}", "--rate", "50", "--scale", "-3")
        got = pipe.read_bytes()  # until it is closed
        program.communicate(timeout=60)
        messages = re.findall(rb"\xb0\x10([\x00-\x7f])", got)
        self.assertEqual(3 * len(messages), len(got))
        self.assertGreater(len(set(messages)), 3, "a force that changes")
        self.assertEqual(messages[-1], bytes([64]))

    def test_a_serial_line_gets_tcode_and_rests_after_ctrl_c(self):
        master, slave = pty.openpty()
        got = []
        reader = self.read(master, got)
        program = self.start(f"tcode:{os.ttyname(slave)}")
        while not got and program.poll() is None:
            time.sleep(0.01)
        program.send_signal(signal.SIGINT)
        _, errors = program.communicate(timeout=60)
        os.close(slave)
        reader.join()
        os.close(master)
        self.assertEqual((program.returncode, errors), (0, ""))
        lines = b"".join(got).decode().splitlines()
        for line in lines:
            self.assertRegex(line, r"^L0\d{4}I10$")
        self.assertEqual(lines[-1], "L05000I10")

    def test_mistakes_are_told_and_no_file_is_written_over(self):
        other = self.folder / "film.mp4"
        other.write_text("a film")
        link = self.folder / "link"
        os.link(self.film, link)
        for output, said in ((f"tcode:{link}", f"is {self.film}, which is read"),
                             (f"midi:{other}", "is a file, and nothing is written over it"),
                             ("osc:here", "is not osc:HOST:PORT"), ("udp:1", "is none of"), ("tcode:/none", "No such file")):
            program = self.start(output)
            self.assertIn(said, program.communicate(timeout=60)[1])
            self.assertEqual(program.returncode, 1)
        self.assertEqual(other.read_text(), "a film")
        program = self.start("osc:127.0.0.1:9", "--axes", "up")
        self.assertIn("--axes: up is none of fx", program.communicate(timeout=60)[1])
        self.assertEqual(program.returncode, 2)


if __name__ == "__main__":
    unittest.main()
