# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether a hand got the force that a presentation should have had, by its traces."""

import csv
import math
from collections import Counter

from preview import FELT_N, WEBER

AXES = "xyz"


class Ticks:
    """The rows of a haptic trace while the clip played."""

    def __init__(self, path):
        with open(path, encoding="utf-8", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["playing"] == "1"]
        vectors = lambda name: [[float(row[f"{name}_force_{axis}_N"]) for axis in AXES] for row in rows]
        self.wanted, self.delivered = vectors("wanted"), vectors("delivered")
        self.devices = Counter(row["device"] for row in rows)
        self.late = sum(row["found"] == "expired" for row in rows)  # the newest frame was too old to be felt
        self.count = len(rows)

    def root_mean_square(self, vectors):
        return math.sqrt(sum(v * v for vector in vectors for v in vector) / self.count)

    def share(self):
        """Of the wanted force, how much was delivered in its direction."""
        whole = sum(w * w for vector in self.wanted for w in vector)
        return sum(w * d for pair in zip(self.wanted, self.delivered) for w, d in zip(*pair)) / whole if whole else 0.0


def commonest_limit(frame_trace):
    """Why nothing of a frame was felt in the device or the playback, or nothing."""
    with open(frame_trace, encoding="utf-8", newline="") as file:
        limits = Counter(row["device_no_force_reason"] for row in csv.DictReader(file))
    limits.pop("none", None)
    return limits.most_common(1)[0][0] if limits else ""


def judge(haptic_trace, frame_trace, expected_N):
    """The share of the force that was delivered, and what was wrong; nothing if the presentation was as it should be.

    `expected_N`: root mean square of the clip's force with this condition; 0 if there should be none. A hand does not
    notice less than FELT_N, nor a change by less than WEBER.
    """
    ticks = Ticks(haptic_trace)
    if ticks.count == 0:
        return 0.0, "the device did not run while the clip played"
    not_running = 1 - ticks.devices["running"] / ticks.count
    if not_running > WEBER:
        state = (ticks.devices - Counter(running=ticks.count)).most_common(1)[0][0]
        return ticks.share(), f"the device was {state} in {100 * not_running:.0f} % of the time"
    if expected_N == 0:
        felt_N = ticks.root_mean_square(ticks.delivered)
        return 0.0, f"there was a force of {felt_N:.2f} N, and there should be none" if felt_N >= FELT_N else ""
    wanted_N, limit = ticks.root_mean_square(ticks.wanted), commonest_limit(frame_trace)
    reasons = [f"frames were late in {100 * ticks.late / ticks.count:.0f} % of the time"] * (ticks.late > 0)
    reasons += [f"of the device or the playback: {limit}"] * bool(limit)
    because = f" ({', '.join(reasons)})" if reasons else ""
    if abs(wanted_N - expected_N) > WEBER * expected_N:
        return ticks.share(), (f"the film asked for {wanted_N:.3f} N rms, and for {expected_N:.3f} N when it was analysed "
                               f"before{because}")
    if ticks.share() < 1 - WEBER:
        return ticks.share(), f"{100 * ticks.share():.0f} % of the force was delivered{because}"
    return ticks.share(), ""
