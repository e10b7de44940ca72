# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What a haptic trace has, which may still be written."""

import csv
import math
import os


def read_trace(path):
    """(monotonic s, running s, force N, whether it plays) of each tick in a haptic trace, which may still be written."""
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="ascii") as file:
        whole = file.read().rpartition("\n")[0].splitlines()
    return [(int(row["monotonic_ns"]) * 1e-9, int(row["running_ns"]) * 1e-9,
             math.hypot(*(float(row[f"commanded_force_{axis}_N"]) for axis in "xyz")), row["playing"] == "1")
            for row in csv.DictReader(whole)]


def largest_N(ticks):
    return max((force for _, _, force, _ in ticks), default=0)
