#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Sends force, torque and pose of each millisecond to the Lab Streaming Layer, with a marker for each frame that is reached:

    examples/lsl.py PIPE &
    gst-launch-1.0 playbin uri=file:///path/film.mp4 video-filter="spidarmotion haptic-trace=PIPE"

It makes PIPE, reads the haptic trace from it until that ends, and removes it. `study.py run --lsl` sends the same, and a
marker for each trial. Needs pylsl. The stamps are those of the trace, CLOCK_MONOTONIC, which on Linux is LSL's clock: a
sample that is sent late is not stamped late.
"""

import argparse
import csv
import os
import sys

UNITS = {"force": "N", "torque": "Nm", "position": "m", "orientation": ""}
CHANNELS = ([f"delivered_force_{axis}_N" for axis in "xyz"] + [f"delivered_torque_{axis}_Nm" for axis in "xyz"]
            + [f"position_{axis}_m" for axis in "xyz"]
            + [f"orientation_{axis}" for axis in "wxyz"])
RATE_HZ = 1000  # of the haptic loop


class Streams:
    """`lsl`: the module pylsl. `source`: which device, so that a recorder finds the streams again after a break."""

    def __init__(self, lsl, source):
        info = lsl.StreamInfo("spidar", "Force", len(CHANNELS), RATE_HZ, lsl.cf_double64, f"spidar {source}")
        channels = info.desc().append_child("channels")
        for name in CHANNELS:
            channel = channels.append_child("channel")
            channel.append_child_value("label", name)
            channel.append_child_value("unit", next(unit for kind, unit in UNITS.items() if kind in name))
        self.ticks = lsl.StreamOutlet(info)
        self.markers = lsl.StreamOutlet(
            lsl.StreamInfo("spidar markers", "Markers", 1, lsl.IRREGULAR_RATE, lsl.cf_string, f"spidar markers {source}"))
        self.frame_ns = None

    def mark(self, text, monotonic_ns):
        self.markers.push_sample([text], monotonic_ns * 1e-9)

    def add(self, row):
        """A row of the haptic trace, by the names of its columns."""
        monotonic_ns = int(row["monotonic_ns"])
        self.ticks.push_sample([float(row[name]) for name in CHANNELS], monotonic_ns * 1e-9)
        if row["playing"] == "1" and row["frame_ns"] not in (self.frame_ns, "-1"):
            self.frame_ns = row["frame_ns"]
            self.mark(f"frame {self.frame_ns}", monotonic_ns)


def load():
    """The module pylsl. Raises RuntimeError."""
    try:
        import pylsl
    except (ImportError, RuntimeError) as error:
        raise RuntimeError(f"the Lab Streaming Layer cannot be used: {error}; install pylsl with liblsl") from None
    return pylsl


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pipe", metavar="PIPE")
    path = parser.parse_args().pipe
    try:
        streams = Streams(load(), os.uname().nodename)
        os.mkfifo(path)
    except (OSError, RuntimeError) as error:
        sys.exit(f"lsl.py: {error}")
    try:
        with open(path, encoding="utf-8", newline="") as trace:
            for row in csv.DictReader(trace):
                streams.add(row)
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        os.unlink(path)


if __name__ == "__main__":
    main()
