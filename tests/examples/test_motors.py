#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""examples/motors.py: what it sends to sockets, pipes and serial lines that stall, go away and come back, and that it ends
at rest: test_motors.py EXAMPLES"""

import contextlib
import errno
import fcntl
import os
import pty
import re
import select
import signal
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import termios
import unittest
from pathlib import Path
from unittest import mock

try:
    import mido  # noqa: F401
    import serial  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}; Debian has it in python3-mido and python3-serial", file=sys.stderr)
    sys.exit(77)

EXAMPLES = Path(sys.argv.pop(1) if len(sys.argv) > 1 else "examples")
sys.path.insert(0, str(EXAMPLES))

import motors  # noqa: E402


def parsed(*arguments):
    with mock.patch.object(sys, "argv", ["motors.py", "film.avi", *arguments]):
        return motors.parse()


def read_all(file):
    os.set_blocking(file, False)
    text = b""
    with contextlib.suppress(OSError):
        while part := os.read(file, 65536):
            text += part
    return text


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.said = Path(folder.name), []
        saying = mock.patch.object(motors, "say", self.said.append)
        saying.start()
        self.addCleanup(saying.stop)

    def board(self):
        """A pseudoterminal; its name is a link, as those of udev are."""
        board, line = pty.openpty()
        link = self.folder / "board"
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(line))
        self.addCleanup(os.close, line)
        return board, link

    def output(self, *arguments):
        options = parsed(*arguments)
        output = motors.KINDS[options.kind](options)
        for target, _ in getattr(output, "targets", []):
            self.addCleanup(target.close)
        return output

    def inlet(self, host, port=0):
        inlet = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(inlet.close)
        inlet.settimeout(60)
        inlet.bind((host, port))
        return inlet, inlet.getsockname()[1]


class Ports(Case):
    def test_a_rate_that_the_line_does_not_carry_is_refused_with_the_one_that_fits(self):
        # Nine bytes for an axis and an interval of two digits, one between two or at the end; ten bits each.
        for wrong, fits in (("tcode:x --axes fx,fy --baud 9600 --rate 100", "48, which the line carries"),
                            ("tcode:x --axes fx,fy,fz,tx,ty,tz --rate 500", "213, "), ("tcode:x --rate 1001", "1000$"),
                            ("midi:x --axes fx,fy,fz --rate 400", "347, "), ("osc:h:1 --rate 0", "1000$"),
                            ("osc:h:1 --rate nan", "1000$"), ("tcode:x --rate=-inf", "1000$"), ("tcode:x --rate .5", "1000$")):
            with self.subTest(wrong), contextlib.redirect_stderr(mock.Mock()) as errors, self.assertRaises(SystemExit):
                parsed(*wrong.split())
            self.assertRegex("".join(call.args[0] for call in errors.write.call_args_list).rstrip(), f"is from 1 to {fits}")
        self.assertEqual(parsed("tcode:x", "--axes", "fx,fy", "--baud", "9600").rate, 48)
        self.assertEqual((parsed("tcode:x").rate, parsed("osc:h:1").rate), (100, 1000))

    def test_osc_comes_at_each_address_and_at_a_broadcast(self):
        four, port = self.inlet("127.0.0.1")
        inlets = [four]
        with contextlib.suppress(OSError):  # a machine without IPv6
            inlets.append(self.inlet("::1", port)[0])
        every = self.inlet("", 0)
        addresses = [(each.family, socket.SOCK_DGRAM, 17, "", each.getsockname()) for each in reversed(inlets)]
        with mock.patch.object(socket, "getaddrinfo", return_value=addresses):
            self.output(f"osc:localhost:{port}").send([.5, -1])
        self.output(f"osc:127.255.255.255:{every[1]}").send([.5, -1])
        for inlet in *inlets, every[0]:
            self.assertEqual(inlet.recv(99), b"/spidar\0,ff\0" + struct.pack(">ff", .5, -1))
        for count in range(1, 7):
            self.assertEqual(len(motors.osc_message([0] * count)) % 4, 0)

    def test_a_network_that_goes_away_and_comes_back_is_told(self):
        inlet, port = self.inlet("127.0.0.1")
        output = self.output(f"osc:127.0.0.1:{port}")
        output.targets = [(mock.Mock(sendto=mock.Mock(side_effect=[OSError(errno.ENETUNREACH, ""), None])), address)
                          for _, address in output.targets]
        output.send([1])
        output.send([1])
        self.assertRegex("\n".join(self.said), r"Network is unreachable; /spidar may stay .*\n.*is back$")

    def test_midi_has_what_has_changed_and_all_of_the_rest(self):
        os.mkfifo(pipe := self.folder / "midi")
        inlet = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, inlet)
        output = self.output(f"midi:{pipe}", "--axes", "fx,fy", "--channel", "2")
        for values in ([-1, 0], [-1, .001], [5, 0]):
            output.send(values)
        self.assertEqual(read_all(inlet), bytes([0xB1, 16, 0, 0xB1, 17, 64, 0xB1, 16, 127]))
        output.rest()
        self.assertEqual(read_all(inlet)[:6], bytes([0xB1, 16, 64, 0xB1, 17, 64]))

    def test_a_midi_port_has_a_part_of_a_name(self):
        (self.folder / "ports.py").write_text("names = ['Synth 24:0']\nclass Output:\n"
                                              "    def __init__(self, name, **_): self.name, self.got = name, []\n"
                                              "    def send(self, message): self.got.append(message)\n"
                                              "    def close(self): pass\n"
                                              "def get_devices(**_): return [{'name': name, 'is_input': False, "
                                              "'is_output': True} for name in names]\n")
        with mock.patch.object(sys, "path", [str(self.folder), *sys.path]), \
                mock.patch.object(mido, "backend", backend := mido.Backend("ports")), \
                mock.patch.multiple(mido, get_output_names=backend.get_output_names, open_output=backend.open_output):
            output = self.output("midi:Synth")
            output.send([1])
            self.assertEqual(output.put.__self__.got[0].bytes(), [0xB0, 16, 127])
            with self.assertRaisesRegex(ValueError, "there are: Synth 24:0"):
                self.output("midi:Piano")
            backend.module.names.clear()
            output.rest()
            self.assertRegex(output.unsaid, "the rest .*: control 16 may still move")
            backend.module.names.append("Synth 28:0")
            output.send([1])
            self.assertEqual(self.said[-1], "midi:Synth: is back")
            self.assertEqual([message.value for message in output.put.__self__.got], [127])

    def test_a_board_that_stops_reading_is_told_and_gets_the_rest_first(self):
        board, line = self.board()
        self.addCleanup(os.close, board)
        output = self.output(f"tcode:{line}")
        while not output.lost:
            output.send([1])
        self.assertIn("takes nothing; L0 may stay", self.said[0])
        output.rest()
        self.assertEqual(output.unsaid, "")
        # What was cut is on the line of the rest.
        self.assertRegex(read_all(board).decode(), r"^(L09999I10\n)*\S*( L05000I10\n){1}L05000I10\n$")

    def test_an_unplugged_board_is_told_and_taken_back(self):
        board, line = self.board()
        output = self.output(f"tcode:{line}", "--axes", "fy,tz")
        output.send([-1, 1])
        self.assertEqual(read_all(board), b"L00000I10 R19999I10\n")
        os.close(board)
        for _ in range(3):
            output.send([1, 1])
        self.assertEqual(len(self.said), 1)
        self.assertFalse(output.port.is_open, "else its name stays taken")
        self.assertRegex(self.said[0], "Input/output error.*; L0, R1 may stay as they are; it is tried again")
        output.rest()
        self.assertRegex(output.unsaid, "did not take the rest .*: L0, R1 may still move; switch off")
        board, _ = self.board()
        self.addCleanup(os.close, board)
        output.rest()
        self.assertEqual((self.said[-1], output.unsaid), (f"tcode:{line}: is back", ""))
        self.assertEqual(read_all(board), 2 * b"L05000I10 R15000I10\n")


class Ends(Case):
    def forward(self, rows, *arguments, sends=1):
        """What is sent of a trace that has these rows at once, and is ended after so many messages."""
        os.mkfifo(pipe := self.folder / "trace")
        trace = motors.Trace(pipe)
        into = os.open(pipe, os.O_WRONLY)
        self.addCleanup(os.close, into)
        os.write(into, b"tick,commanded_force_y_N\n" + rows)
        ended, ending = os.pipe()
        output, got = self.output("osc:127.0.0.1:9", *arguments), []

        def write(values, _rests):
            got.append(values[0])
            if len(got) == sends:
                os.write(ending, b"1")
        output.write = write
        with contextlib.suppress(ValueError):
            motors.forward(trace, ended, output)
        return got

    def test_only_the_newest_row_is_sent_and_the_rest_is_not_scaled(self):
        self.assertEqual(self.forward(b"1,3\n2,-3\n3,1.5\n4,-", "--scale", "1e308"), [1, 0, 0])

    def test_a_row_that_cannot_be_read_ends_at_rest(self):
        self.assertEqual(self.forward(b"1,x\n"), [0, 0])

    def test_a_trace_that_stands_still_is_no_force(self):
        with mock.patch.object(motors, "STALL_S", .01):
            self.assertEqual(self.forward(b"1,3\n", sends=2), [1, 0, 0, 0])

    def test_what_is_missing_is_named_with_its_package(self):
        for output, module in (("midi:x", "mido"), ("tcode:x", "serial")):
            with mock.patch.dict(sys.modules, {module: None}), self.assertRaisesRegex(ValueError, f"needs python3-{module}: "):
                self.output(output)


class Firmware(Case):
    def test_it_follows_t_code_and_rests_in_silence(self):
        compiler = shutil.which("c++") or self.skipTest("no C++ compiler")
        header = Path(__file__).with_name("tcode_board.h")
        (self.folder / "Servo.h").touch()
        subprocess.run([compiler, "-std=c++17", "-Wall", "-Werror", "-I", self.folder, "-include", header, "-x", "c++",
                        EXAMPLES / "tcode" / "tcode.ino", "-o", self.folder / "board"], check=True)
        for said, pulses in (("L09999I10\n", "9:2000"), ("L00 R0123I10\r\n", "9:1000 10:1123"), ("L05000\nL1000\n", ""),
                             ("L0999 L05000I10\n", "9:1999 9:1500"), ("L0\nL\n\nD0\nL09", ""), (200 * "R09 " + "\n", ""),
                             ("R00\n~\n", "10:1000 10:1500")):
            done = subprocess.run([self.folder / "board"], input=said, capture_output=True, text=True, check=True)
            self.assertEqual(done.stdout.split(), ["9:1500", "10:1500", *pulses.split()], said)


class Film(Case):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.film = Path(folder.name) / "a:ball.avi"
        subprocess.run(["gst-launch-1.0", "-q", "videotestsrc", "pattern=ball", "num-buffers=50", "!",
                        "video/x-raw,width=320,height=240,framerate=25/1", "!", "jpegenc", "!", "avimux", "!", "filesink",
                        f"location={cls.film}"], check=True)

    def start(self, *arguments, **more):
        program = subprocess.Popen([sys.executable, EXAMPLES / "motors.py", "--headless", self.film, *arguments],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
        for each in program.kill, program.stdout.close, program.stderr.close:
            self.addCleanup(each)
        return program

    def test_osc_has_the_force_and_ends_at_rest(self):
        inlet, port = self.inlet("127.0.0.1")
        inlet.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        program = self.start(f"osc:127.0.0.1:{port}", "--axes", "fx,fy")
        said, errors = program.communicate(timeout=60)
        self.assertEqual((program.returncode, errors), (0, ""))
        inlet.setblocking(False)
        values = []
        with contextlib.suppress(BlockingIOError):
            while True:
                values.append(struct.unpack(">ff", inlet.recv(64)[-8:]))
        self.assertIn(f"{len(values)} messages sent to osc:", said)
        self.assertEqual(values[-1], (0, 0))
        # A hand feels 0.04 N, of the full 3 N.
        self.assertGreater(max(max(map(abs, value)) for value in values), 0.04 / 3)
        self.assertTrue(all(-1 <= each <= 1 for value in values for each in value))

    def test_however_it_ends_a_board_rests(self):
        """Also when the terminal is closed, its controlling one, with which its messages go."""
        for end in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP, "terminal":
            with self.subTest(end):
                board, line = self.board()
                terminal, inside = pty.openpty()
                program = self.start(f"tcode:{line}", start_new_session=True, stdin=inside, preexec_fn=lambda: fcntl.ioctl(
                    0, termios.TIOCSCTTY, 0))
                os.close(inside)
                got = b""
                while re.fullmatch(rb"(L05000I10\n)*[^\n]*", got):  # until it moves
                    if not select.select([board], [], [], 60)[0]:
                        program.kill()
                        self.fail(program.communicate()[1])
                    got += os.read(board, 4096)
                os.close(terminal) if end == "terminal" else program.send_signal(end)
                _, errors = program.communicate(timeout=60)
                if end != "terminal":
                    os.close(terminal)
                got += read_all(board)
                os.close(board)
                self.assertEqual(program.returncode, 0, errors)
                # A program that gets no processor for WRITE_S takes a message for cut, and says so.
                self.assertNotIn("did not take the rest", errors)
                self.assertRegex(got.decode(), r"^(\s*L0\S*\s)*\s*L05000I10\n$")

    def test_what_cannot_be_played_is_told_and_a_board_rests(self):
        board, line = self.board()
        self.addCleanup(os.close, board)
        for wrong, said in ((["--scale", "nan"], "nan: is not a finite number"), (["--scale", "inf"], "inf: is not")):
            program = self.start(f"tcode:{line}", *wrong)
            self.assertIn(said, program.communicate(timeout=60)[1])
            self.assertEqual((program.returncode, read_all(board)), (1, 2 * b"L05000I10\n"))

    def test_mistakes_are_told_and_no_file_is_written_over(self):
        other = self.folder / "film.mp4"
        other.write_text("a film")
        for output, said, status in ((f"midi:{other}", "is a file, and nothing is written over it", 2),
                                     ("udp:1", "is none of", 2), ("osc:here", "is not osc:HOST:PORT", 1),
                                     ("tcode:/none", "No such file", 1), (f"tcode:{self.folder}", "is no serial line", 1)):
            program = self.start(output)
            self.assertIn(said, program.communicate(timeout=60)[1])
            self.assertEqual(program.returncode, status)
        self.assertEqual(other.read_text(), "a film")
        program = self.start("osc:127.0.0.1:9", "--axes", "up")
        self.assertIn("--axes: up is none of fx", program.communicate(timeout=60)[1])


if __name__ == "__main__":
    unittest.main()
