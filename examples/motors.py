#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a film, and sends its force to motors, programs or instruments of your own.

    motors.py FILM osc:HOST:PORT     OSC over UDP: /spidar with a float from -1 to 1 for each axis
    motors.py FILM midi:PORT         control changes 0 to 127, at rest 64, from --control on: part of the name of a
                                     port, or a device such as /dev/snd/midiC1D0
    motors.py FILM tcode:PORT        T-code on a serial line, /dev/ttyUSB0: L0 up, L1 forwards, L2 sideways, R0 to R2

Without a second word, it asks. What is sent last, however it ends, is the rest. The force is that of the simulated
device, with its limits. Needs python3-gi and gir1.2-gstreamer-1.0; for MIDI python3-mido and python3-rtmidi, for T-code
python3-serial.
"""
import argparse
import contextlib
import fcntl
import importlib
import math
import os
import select
import signal
import socket
import stat
import struct
import sys
import tempfile
import threading
import time

import gi

gi.require_version("Gst", "1.0")
from gi.repository import Gst  # noqa: E402

AXES = {f"{kind}{axis}": f"commanded_{column}_{axis}_{unit}" for kind, column, unit in
        (("f", "force", "N"), ("t", "torque", "Nm")) for axis in "xyz"}
FULL = {"f": 3.0, "t": 0.1}  # N and N m, the limits of the element
TCODE = {"fx": "L2", "fy": "L0", "fz": "L1", "tx": "R2", "ty": "R0", "tz": "R1"}
BITS = 10  # of a byte on a serial line: a start, eight of data, a stop
MIDI_BAUD = 31250
WRITE_S = 0.04  # a write that nobody takes and then the rest are to last less than 0.1 s
STALL_S = 0.5  # a trace or a line that stands still for this long will not go on by itself
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGTSTP)


def osc_message(values):
    """An address and types, each with zeros up to a multiple of four bytes, and floats."""
    pad = lambda text: text.encode() + b"\0" * (4 - len(text) % 4)
    return pad("/spidar") + pad("," + "f" * len(values)) + struct.pack(f">{len(values)}f", *values)


def tcode_message(values, axes, rate):
    """Positions 0000 to 9999, to be reached when the next ones come."""
    return (" ".join(f"{TCODE[axis]}{round(4999.5 + 4999.5 * value):04d}I{max(1, round(1000 / rate))}"
                     for axis, value in zip(axes, values)) + "\n").encode()


def load(name, package):
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ValueError(f"needs {package}: sudo apt install {package}") from error


def say(text, descriptor=2):
    with contextlib.suppress(OSError):  # the terminal may be closed
        os.write(descriptor, f"{text}\n".encode())


class Output:
    """Sends values from -1 to 1. What is wrong is said at once, and so is that the port has come back."""

    reopens = True

    def __init__(self, options):
        """Raises ValueError for what cannot be meant, and OSError."""
        self.options, self.sent, self.lost, self.unsaid, self.failed = options, 0, "", "", ""
        self.open()
        self.is_open = True

    def send(self, values, rests=False):
        """Lasts WRITE_S at most, or as long as the rest is on its way."""
        try:
            if not self.is_open:
                self.open()
                self.is_open = True
            self.write([min(1, max(-1, value)) for value in values], rests)
        except Exception as error:  # libraries have some of their own
            reason = os.strerror(error.errno) if getattr(error, "errno", None) else str(error)
            if not self.lost:
                say(f"{self.options.output}: {reason}; {self.moved} may stay as they are; it is tried again")
            self.lost = reason
            if self.is_open and self.reopens and not isinstance(error, TimeoutError):
                self.is_open = False
                with contextlib.suppress(Exception):
                    self.close()
        else:
            if self.lost:
                say(f"{self.options.output}: is back")
            self.lost = ""
            self.sent += 1

    def rest(self):
        for _ in range(2):  # the first may find the line full
            self.send([0.0] * len(self.options.axes), rests=True)
        self.unsaid = self.lost and (f"{self.options.output}: did not take the rest ({self.lost}): {self.moved} may still "
                                     "move; switch off the supply of the motors")


class Osc(Output):
    """UDP does not say who listens, so that each address of a host gets the message; "localhost" has two."""

    moved, reopens = "/spidar", False  # looking a name up lasts; a network that comes back needs no new socket

    def open(self):
        host, _, port = self.options.place.rpartition(":")
        if not host or not port.isdigit() or not 0 < int(port) < 65536:
            raise ValueError("is not osc:HOST:PORT, such as osc:127.0.0.1:9000")
        self.targets = []
        for family, kind, _, _, address in socket.getaddrinfo(host.strip("[]"), int(port), type=socket.SOCK_DGRAM):
            target = socket.socket(family, kind)
            target.setblocking(False)
            target.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
            self.targets.append((target, address))

    def write(self, values, _rests):
        errors = []
        for target, address in self.targets:
            try:
                target.sendto(osc_message(values), address)
            except OSError as error:
                errors.append(error)
        if len(errors) == len(self.targets):
            raise errors[0]


class Midi(Output):
    def open(self):
        options, mido = self.options, load("mido", "python3-mido")
        self.moved = ", ".join(f"control {options.control + i}" for i in range(len(options.axes)))
        self.message, self.last, self.looked_s, self.is_there = mido.Message, {}, 0, lambda: True
        if "/" in options.place:
            device = os.open(options.place, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY)
            self.close, self.put = lambda: os.close(device), lambda message: os.write(device, message.bin())
            return
        if mido.backend.name == "mido.backends.rtmidi":
            load("rtmidi", "python3-rtmidi")
        found = [name for name in mido.get_output_names() if options.place in name]
        if not found:
            names = ", ".join(mido.get_output_names()) or "none"
            raise ValueError(f"is no part of the name of a MIDI port; there are: {names}")
        port = mido.open_output(found[0])
        self.is_there = lambda: found[0] in mido.get_output_names()
        self.close, self.put = port.close, port.send

    def write(self, values, rests):
        """Controls that have changed. A port whose device is gone takes them, too."""
        if rests or time.monotonic() > self.looked_s + STALL_S:
            if not self.is_there():
                raise OSError("is gone")
            self.looked_s = time.monotonic()
        for control, value in enumerate(values, self.options.control):
            message = self.message("control_change", channel=self.options.channel - 1, control=control,
                                   value=min(127, round(64 + 64 * value)))
            if rests or self.last.get(control) != message.value:
                self.put(message)
            self.last[control] = message.value


class TCode(Output):
    def open(self):
        self.serial = load("serial", "python3-serial")
        self.moved, self.cut = ", ".join(TCODE[axis] for axis in self.options.axes), False
        if not stat.S_ISCHR(os.stat(self.options.place).st_mode):
            raise ValueError("is no serial line")
        self.port = self.serial.Serial(self.options.place, self.options.baud, write_timeout=WRITE_S, exclusive=True)

    def close(self):
        try:
            self.port.reset_output_buffer()  # the system would wait until it is taken
        finally:
            self.port.close()  # a device that comes back gets another name while its old one is open

    def write(self, values, rests):
        now_s = time.monotonic()
        try:
            if rests and self.port.out_waiting:
                self.drop()
            # A blank ends a message that was cut, and the rest of the line replaces it.
            self.port.write(b" " * self.cut + tcode_message(values, self.options.axes, self.options.rate))
            self.cut = False
            while rests and self.port.out_waiting:
                if time.monotonic() > now_s + STALL_S:
                    raise self.serial.SerialTimeoutException
                time.sleep(0.001)
        except self.serial.SerialTimeoutException:
            self.drop()
            raise TimeoutError("takes nothing") from None

    def drop(self):
        self.port.reset_output_buffer()
        self.cut = True


KINDS = {"osc": Osc, "midi": Midi, "tcode": TCode}


class Trace:
    """A haptic trace that comes through a pipe."""

    def __init__(self, pipe):
        self.pipe, self.text, self.columns = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK), b"", []
        # A second of rows, each less than 1000 bytes: else old ones would wait behind those that are read at 1 Hz.
        fcntl.fcntl(self.pipe, fcntl.F_SETPIPE_SZ, 1 << 20)

    def newest(self):
        """The last row since the call before, by the names of the columns; or nothing."""
        with contextlib.suppress(BlockingIOError):
            while part := os.read(self.pipe, 1 << 16):
                self.text += part
        *rows, self.text = self.text.split(b"\n")
        if rows and not self.columns:
            self.columns = rows.pop(0).decode().split(",")
        return dict(zip(self.columns, rows[-1].decode().split(","))) if rows else {}


def forward(trace, ended, output):
    """Sends what is newest as often as is wanted, and the rest when `ended` can be read, or after an error."""
    options, next_s, row_s = output.options, time.monotonic(), math.inf
    try:
        while not select.select([ended], [], [], max(0, next_s - time.monotonic()))[0]:
            row, now_s = trace.newest(), time.monotonic()
            next_s = max(next_s + 1 / options.rate, now_s)
            if row:
                row_s = now_s
                output.send([options.scale * float(row[AXES[axis]]) / FULL[axis[0]] for axis in options.axes])
            elif now_s > row_s + STALL_S:
                output.send([0.0] * len(options.axes))
    except (KeyError, ValueError) as error:
        output.failed = f"the trace cannot be read: {error!r}"
    finally:
        output.rest()


def most_rate(options):
    """In hertz: as many messages as the line carries, and no more than there are ticks."""
    def load_of(rate):
        if options.kind == "tcode":
            return BITS * rate * len(tcode_message([0] * len(options.axes), options.axes, rate)) / options.baud
        return BITS * rate * 3 * len(options.axes) / MIDI_BAUD if options.kind == "midi" else 0
    return max((rate for rate in range(1, 1001) if load_of(rate) <= 1), default=0)


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("film", metavar="FILM", help="a file or URI")
    parser.add_argument("output", metavar="OUTPUT", nargs="?", help="osc:…, midi:… or tcode:…")
    parser.add_argument("--axes", metavar="AXIS,…", default="fy", type=lambda text: text.split(","),
                        help="of fx, fy, fz, tx, ty, tz; default: fy, up")
    parser.add_argument("--scale", type=float, default=1, metavar="FACTOR",
                        help="1, the default: 3 N or 0.1 N m is the full range; negative: the other way")
    parser.add_argument("--rate", type=float, metavar="HZ", help="1 to what a line carries, and to 1000; "
                        "default: 1000 for OSC, else 100 or what the line carries")
    parser.add_argument("--control", type=int, default=16, metavar="N", help="of MIDI, for the first axis; default: 16")
    parser.add_argument("--channel", type=int, default=1, metavar="N", help="of MIDI, 1 to 16")
    parser.add_argument("--baud", type=int, default=115200, metavar="RATE", help="of a serial line; default: 115200")
    parser.add_argument("--headless", action="store_true", help="no window and no sound")
    options = parser.parse_args()
    if not options.output and sys.stdin.isatty():
        options.output = input("send the force to osc:HOST:PORT, midi:PORT or tcode:PORT? ").strip()
    if not options.output:
        parser.error("no OUTPUT is given")
    options.kind, _, options.place = options.output.partition(":")
    if options.kind not in KINDS or not options.place:
        parser.error(f"{options.output}: is none of osc:HOST:PORT, midi:PORT and tcode:PORT")
    if os.path.isfile(options.place):
        parser.error(f"{options.place}: is a file, and nothing is written over it; name a port or a device")
    unknown = [axis for axis in options.axes if axis not in AXES]
    if unknown:
        parser.error(f"--axes: {', '.join(unknown)} is none of {', '.join(AXES)}")
    if not 0 <= options.control <= 120 - len(options.axes) or not 1 <= options.channel <= 16:
        parser.error(f"--control is from 0 to {120 - len(options.axes)}, and --channel from 1 to 16")
    most = most_rate(options) if options.baud > 0 else 0
    if not most:
        parser.error(f"--baud {options.baud}: carries no message a second; name the board's, such as 115200")
    if options.rate is None:
        options.rate = min(most, 1000 if options.kind == "osc" else 100)
    if not 1 <= options.rate <= most:
        parser.error(f"--rate {options.rate:g}: is from 1 to {most}" + ", which the line carries" * (most < 1000))
    return options


def make_player(options, trace):
    """Raises ValueError."""
    Gst.init(None)
    motion = Gst.ElementFactory.make("spidarmotion")
    if not motion:
        raise ValueError("GStreamer finds no spidarmotion; set GST_PLUGIN_PATH to the folder of libgstspidar.so")
    motion.set_property("haptic-trace", trace)
    player = Gst.ElementFactory.make("playbin")
    player.set_property("video-filter", motion)
    is_file = os.path.exists(options.film) or not Gst.uri_is_valid(options.film)
    player.set_property("uri", Gst.filename_to_uri(options.film) if is_file else options.film)
    if options.headless:
        for sink in "video-sink", "audio-sink":
            player.set_property(sink, Gst.parse_launch("fakesink sync=true"))
    return player


def play(options, player, sender):
    """Until the film or the thread that sends has ended; returns what is wrong, or nothing."""
    if not math.isfinite(options.scale):
        return f"--scale {options.scale}: is not a finite number, such as 0.5"
    player.set_state(Gst.State.PLAYING)
    message = None
    while not message and sender.is_alive():
        message = player.bus.timed_pop_filtered(100 * Gst.MSECOND, Gst.MessageType.ERROR | Gst.MessageType.EOS)
    return f"{options.film}: {message.parse_error()[0].message}" if message and message.type == Gst.MessageType.ERROR else ""


def main():
    options = parse()
    ended, ending = os.pipe()
    os.set_blocking(ending, False)
    signal.set_wakeup_fd(ending)  # so that the thread that sends hears of it, whatever this one does
    heard = [each for each in ENDS if signal.getsignal(each) != signal.SIG_IGN]  # as nohup has it
    for each in heard:
        signal.signal(each, lambda *_: None)
    with tempfile.TemporaryDirectory() as folder:
        pipe = os.path.join(folder, "trace")
        os.mkfifo(pipe)
        try:
            trace, player = Trace(pipe), make_player(options, pipe)
            output = KINDS[options.kind](options)
        except (OSError, ValueError) as error:
            sys.exit(f"motors.py: {options.output}: {error}")
        sender = threading.Thread(target=forward, args=(trace, ended, output))
        sender.start()
        wrong = ""
        try:
            # Also if it moves nothing, it leaves what it opened at rest.
            wrong = play(options, player, sender)
        finally:
            os.write(ending, b"\0")
            sender.join()
            for each in heard:
                signal.signal(each, signal.SIG_DFL)  # in case the player hangs
            player.set_state(Gst.State.NULL)
    if not output.unsaid:
        say(f"{output.sent} messages sent to {options.output}, the last one the rest", 1)
    sys.exit("\n".join(filter(None, [wrong, output.failed, output.unsaid])) or 0)


if __name__ == "__main__":
    main()
