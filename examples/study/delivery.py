# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether a hand got the force that a presentation should have had, by its traces."""

import csv
from collections import Counter

import numpy as np

from perception import FELT_N, WEBER

AXES = "xyz"
MS_NS = 1_000_000
# Of a tick, whose force then stands for that millisecond. The loop runs at 1 kHz, and its ticks are late by some
# milliseconds on a machine that is not real-time.
MOST_AGE_MS = 10
MOST_STALL_MS = 100


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Hand:
    """What a hand should have got and what it got in each millisecond of a clip's own time, from first to last frame.

    `wanted`: rows of time, ns, and force, N, one for each frame. A millisecond is not `shown`, and has no force, if no tick
    of the playing clip is for it, or one whose frame is held or too old: the picture or the device stood still. Of a
    muted clip the trace does not tell how old a frame is.
    """

    def __init__(self, haptic_trace, wanted, is_muted):
        playing = [row for row in rows_of(haptic_trace) if row["playing"] == "1"]
        wanted = np.asarray(wanted, float)
        self.device, self.count = Counter(row["device"] for row in playing), len(playing)
        self.time_ns = np.arange(wanted[0, 0], wanted[-1, 0] + 1, MS_NS)
        self.wanted = (0 if is_muted else 1) * np.stack(
            [np.interp(self.time_ns, wanted[:, 0], wanted[:, 1 + n]) for n in range(3)], axis=1)
        numbers = lambda name: np.array([float(row[name]) for row in playing] or [np.nan])
        moves = np.array([row["found"] in ("exact", "interpolated") or is_muted for row in playing] or [False])
        running_ns, force_N = numbers("running_ns"), [numbers(f"delivered_force_{axis}_N") for axis in AXES]
        newest = np.maximum(np.searchsorted(running_ns, self.time_ns + MS_NS, side="left") - 1, 0)
        self.shown = moves[newest] & (np.abs(self.time_ns - running_ns[newest]) <= MOST_AGE_MS * MS_NS)
        self.delivered = np.where(self.shown[:, None], np.stack(force_N, axis=1)[newest], 0)
        # How long the clip stood still before the tick of each millisecond.
        self.waited_ms = np.diff(numbers("monotonic_ns"), prepend=np.nan)[newest] / MS_NS

    def felt(self):
        return np.linalg.norm(self.wanted, axis=1) >= FELT_N

    def share(self):
        """Of the time in which something is to be felt, the part of the wanted force that came, in its direction."""
        wanted, delivered = self.wanted[self.felt()], self.delivered[self.felt()]
        if not len(wanted):
            return 1.0
        return float(np.clip((wanted * delivered).sum(axis=1) / (wanted**2).sum(axis=1), -1, 1).mean())

    def longest_stall_ms(self):
        """Of the picture, or of a force that should be felt."""
        is_weak = self.felt() & (np.linalg.norm(self.delivered, axis=1) < np.linalg.norm(self.wanted, axis=1) / 2)
        longest = run = 0
        for stands in ~self.shown | is_weak:
            run = run + 1 if stands else 0
            longest = max(longest, run)
        return max(longest, np.nanmax(self.waited_ms, initial=0))


def root_mean_square(vectors):
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))


def cause(haptic_trace, frame_trace):
    """What the traces say of a force that did not come, in brackets, or nothing."""
    found = Counter(row["found"] for row in rows_of(haptic_trace) if row["playing"] == "1")
    reasons = [f"frames were late in {100 * found['expired'] / found.total():.0f} % of the time"] * (found["expired"] > 0)
    limits = Counter(row["device_no_force_reason"] for row in rows_of(frame_trace))
    limits.pop("none", None)
    reasons += [f"of the device or the playback: {limit}" for limit, _ in limits.most_common(1)]
    return f" ({', '.join(reasons)})" if reasons else ""


def judge(haptic_trace, frame_trace, wanted, is_muted):
    """The share of the force that was delivered, and what was wrong; nothing if the presentation was as it should be.

    `wanted`: of the clip with this condition, as its preview found it (`Hand`). `is_muted`: there should be no force. A
    hand does not notice less than FELT_N, nor a change by less than WEBER.
    """
    hand = Hand(haptic_trace, wanted, is_muted)
    if hand.count == 0:
        return 0.0, "the device did not run while the clip played"
    share = 0.0 if is_muted else hand.share()
    because = cause(haptic_trace, frame_trace)
    not_running = 1 - hand.device["running"] / hand.count
    if not_running > WEBER:
        state = (hand.device - Counter(running=hand.count)).most_common(1)[0][0]
        return share, f"the device was {state} in {100 * not_running:.0f} % of the time"
    if share < 1 - WEBER and not is_muted:
        return share, f"{100 * share:.0f} % of the clip's force was delivered{because}"
    if hand.shown.mean() < 1 - WEBER:
        return share, f"{100 * hand.shown.mean():.0f} % of the clip was shown{because}"
    if hand.longest_stall_ms() > MOST_STALL_MS:
        return share, f"picture or force stood still for {hand.longest_stall_ms():.0f} ms{because}"
    delivered_N, wanted_N = root_mean_square(hand.delivered), root_mean_square(hand.wanted)
    if delivered_N > max(FELT_N, (1 + WEBER) * wanted_N):
        return share, f"there was a force of {delivered_N:.3f} N rms, and there should be {wanted_N:.3f} N"
    return share, ""
