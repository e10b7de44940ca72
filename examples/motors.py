#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays a film, and sends its force to motors, programs or instruments of your own.

    motors.py FILM osc:HOST:PORT     OSC over UDP: /spidar with a float from -1 to 1 for each axis
    motors.py FILM midi:FILE         control changes 0 to 127, at rest 64, from --control on: /dev/snd/midiC1D0
    motors.py FILM tcode:FILE        T-code on a serial line: L0 up, L1 forwards, L2 sideways, R0 to R2

Without a second word, it asks. What is sent last, also after Ctrl+C or an error, is the rest. The force is that of the
simulated device, with its limits. Needs python3-gi and gir1.2-gstreamer-1.0.
"""
import argparse
import csv
import os
import signal
import socket
import struct
import sys
import tempfile
import termios
import threading
import tty

from own_files import require_other

AXES = {f"{kind}{axis}": f"commanded_{column}_{axis}_{unit}" for kind, column, unit in
        (("f", "force", "N"), ("t", "torque", "Nm")) for axis in "xyz"}
FULL = {"f": 3.0, "t": 0.1}  # N and N m, the limits of the element
TCODE = {"fx": "L2", "fy": "L0", "fz": "L1", "tx": "R2", "ty": "R0", "tz": "R1"}
BAUD = {rate: getattr(termios, f"B{rate}") for rate in (9600, 19200, 38400, 57600, 115200, 230400, 460800)}


def osc_message(values):
    """An address and types, each with zeros up to a multiple of four bytes, and floats."""
    pad = lambda text: text.encode() + b"\0" * (4 - len(text) % 4)
    return pad("/spidar") + pad("," + "f" * len(values)) + struct.pack(f">{len(values)}f", *values)


def midi_message(values, control, channel):
    """A status byte of channel 1 to 16, and a controller and its value, for each axis."""
    return b"".join(bytes([0xB0 + channel - 1, control + i, min(127, round(64 + 64 * value))])
                    for i, value in enumerate(values))


def tcode_message(values, axes, interval_ms):
    """Positions 0000 to 9999, to be reached when the next ones come."""
    return (" ".join(f"{TCODE[axis]}{round(4999.5 + 4999.5 * value):04d}I{interval_ms}"
                     for axis, value in zip(axes, values)) + "\n").encode()


class Output:
    """Raises ValueError for what cannot be meant, and OSError."""

    def __init__(self, options):
        kind, _, place = options.output.partition(":")
        self.options, self.sent = options, 0
        self.socket = self.file = None
        if kind == "osc":
            host, _, port = place.rpartition(":")
            if not host or not port.isdigit() or not 0 < int(port) < 65536:
                raise ValueError(f"{options.output}: is not osc:HOST:PORT, such as osc:127.0.0.1:9000")
            address = socket.getaddrinfo(host.strip("[]"), int(port), type=socket.SOCK_DGRAM)[0]
            self.socket = socket.socket(address[0], socket.SOCK_DGRAM)
            self.socket.connect(address[4])
            self.message = osc_message
        elif kind in ("midi", "tcode") and place:
            require_other(place, options.film)
            self.file = os.open(place, os.O_WRONLY | os.O_NOCTTY)
            self.message = (lambda values: midi_message(values, options.control, options.channel)) if kind == "midi" else (
                lambda values: tcode_message(values, options.axes, max(1, round(1000 / options.rate))))
            if os.isatty(self.file):
                tty.setraw(self.file)
                settings = termios.tcgetattr(self.file)
                settings[4] = settings[5] = BAUD[options.baud]
                termios.tcsetattr(self.file, termios.TCSANOW, settings)
            elif os.path.isfile(place):
                raise ValueError(f"{place}: is a file, and nothing is written over it; name a line or a MIDI device")
        else:
            raise ValueError(f"{options.output}: is none of osc:HOST:PORT, midi:FILE and tcode:FILE")

    def send(self, values):
        message = self.message([min(1, max(-1, self.options.scale * value)) for value in values])
        if self.socket:
            try:
                self.socket.send(message)
            except ConnectionRefusedError:
                pass  # nobody listens yet
        else:
            os.write(self.file, message)
        self.sent += 1

    def rest(self):
        self.send([0.0] * len(self.options.axes))


def forward(trace, output, failed):
    """Rows of a haptic trace, as many a second as are wanted. What goes wrong comes into a list."""
    try:
        send_rows(trace, output)
    except OSError as error:
        failed.append(f"{output.options.output}: {error.strerror}")
        for _ in trace:  # the film plays on
            pass


def send_rows(trace, output):
    next_ns = 0
    for row in csv.DictReader(trace):
        now_ns = int(row["monotonic_ns"])
        if now_ns < next_ns:
            continue
        next_ns = max(next_ns + round(1e9 / output.options.rate), now_ns)
        output.send([float(row[AXES[axis]]) / FULL[axis[0]] for axis in output.options.axes])


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("film", metavar="FILM", help="a file or URI")
    parser.add_argument("output", metavar="OUTPUT", nargs="?", help="osc:…, midi:… or tcode:…")
    parser.add_argument("--axes", metavar="AXIS,…", default="fy", type=lambda text: text.split(","),
                        help="of fx, fy, fz, tx, ty, tz; default: fy, up")
    parser.add_argument("--scale", type=float, default=1, metavar="FACTOR",
                        help="1, the default: 3 N or 0.1 N m is the full range; negative: the other way")
    parser.add_argument("--rate", type=float, metavar="HZ", help="1 to 1000; default: 1000 for OSC, else 100")
    parser.add_argument("--control", type=int, default=16, metavar="N", help="of MIDI, for the first axis; default: 16")
    parser.add_argument("--channel", type=int, default=1, metavar="N", help="of MIDI, 1 to 16")
    parser.add_argument("--baud", type=int, default=115200, choices=BAUD, metavar="RATE", help="of a serial line")
    parser.add_argument("--headless", action="store_true", help="no window and no sound")
    options = parser.parse_args()
    if not options.output and sys.stdin.isatty():
        options.output = input("send the force to osc:HOST:PORT, midi:FILE or tcode:FILE? ").strip()
    if not options.output:
        parser.error("no OUTPUT is given")
    options.rate = options.rate or (1000 if options.output.startswith("osc:") else 100)
    unknown = [axis for axis in options.axes if axis not in AXES]
    if unknown:
        parser.error(f"--axes: {', '.join(unknown)} is none of {', '.join(AXES)}")
    if not 1 <= options.rate <= 1000:
        parser.error("--rate is from 1 to 1000")
    if not 0 <= options.control <= 120 - len(options.axes) or not 1 <= options.channel <= 16:
        parser.error("--control is from 0 to 119, and --channel from 1 to 16")
    return options


def play(options, trace):
    """Until the film ends; returns what is wrong, or nothing."""
    import gi

    gi.require_version("Gst", "1.0")
    from gi.repository import Gst

    Gst.init(None)
    motion = Gst.ElementFactory.make("spidarmotion")
    if not motion:
        return "GStreamer finds no spidarmotion; set GST_PLUGIN_PATH to the folder of libgstspidar.so"
    motion.set_property("haptic-trace", trace)
    player = Gst.ElementFactory.make("playbin")
    player.set_property("video-filter", motion)
    player.set_property("uri", options.film if Gst.uri_is_valid(options.film) else Gst.filename_to_uri(options.film))
    if options.headless:
        for sink in "video-sink", "audio-sink":
            player.set_property(sink, Gst.parse_launch("fakesink sync=true"))
    try:
        player.set_state(Gst.State.PLAYING)
        message = None
        while not message:
            message = player.bus.timed_pop_filtered(100 * Gst.MSECOND, Gst.MessageType.ERROR | Gst.MessageType.EOS)
        return message.parse_error()[0].message if message.type == Gst.MessageType.ERROR else ""
    finally:
        player.set_state(Gst.State.NULL)  # the trace ends with it


def main():
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl+C
    options = parse()
    try:
        output = Output(options)
    except (OSError, ValueError) as error:
        sys.exit(f"motors.py: {error}")
    with tempfile.TemporaryDirectory() as folder:
        pipe = os.path.join(folder, "trace")
        os.mkfifo(pipe)
        # Read from before it is written, and until all writers have closed it.
        with os.fdopen(os.open(pipe, os.O_RDONLY | os.O_NONBLOCK), encoding="utf-8", newline="") as trace:
            keeper = os.open(pipe, os.O_WRONLY)
            os.set_blocking(trace.fileno(), True)
            failed = []
            reader = threading.Thread(target=forward, args=(trace, output, failed))
            reader.start()
            wrong = ""
            try:
                wrong = play(options, pipe)
            except KeyboardInterrupt:
                pass
            finally:
                os.close(keeper)
                reader.join()
    try:
        output.rest()
    except OSError as error:
        failed.append(f"{options.output}: the rest was not sent: {error.strerror}")
    print(f"{output.sent} messages sent to {options.output}, the last one the rest")
    sys.exit("\n".join([f"{options.film}: {wrong}"] * bool(wrong) + failed[:1]) or 0)


if __name__ == "__main__":
    main()
