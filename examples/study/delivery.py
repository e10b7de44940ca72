# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether a hand got the force that a presentation should have had, by its traces."""

import csv
import math
from collections import Counter

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.interpolate import CubicHermiteSpline

from perception import FELT_N, LATE_MS, TURNED_DEG, WEBER

AXES = "xyz"
MS_NS = 1_000_000
# Of a tick, whose force then stands for that millisecond. The loop runs at 1 kHz, and its ticks are late by some
# milliseconds on a machine that is not real-time.
MOST_AGE_MS = 10
MOST_STALL_MS = 100
STEP_MS = 5  # of the lags that are tried, up to
MOST_LAG_MS = 200
# A lag is one if the force fits so much better with it; of a steady force, none does.
BETTER = 0.8
STANDS = 0.05  # a force stands where it moves by less than this part of what it should
NEARER = 0.5  # to its own condition (1) than to another (0)
BANDS_HZ = (8, 16, 32, 64, 128, 256, 500)  # faster than films ask for, up to half of 1 kHz


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def between(samples, time_ns):
    """Forces at times between samples, which are rows of time and force: monotone, as the loop has them
    (core/force/wrench_timeline.h)."""
    samples = np.asarray(samples, float)
    times_ns, first = np.unique(samples[:, 0], return_index=True)
    values = samples[first, 1:]
    if len(times_ns) < 3:
        return np.stack([np.interp(time_ns, times_ns, each) for each in values.T], axis=1)
    step = np.diff(times_ns)[:, None]
    slope = np.diff(values, axis=0) / step
    before, after = slope[:-1], slope[1:]
    tangent = (before * step[1:] + after * step[:-1]) / (step[:-1] + step[1:])
    steepest = 2 * np.minimum(abs(before), abs(after))
    inner = np.where(before * after > 0, np.clip(tangent, -steepest, steepest), 0)
    return CubicHermiteSpline(times_ns, values, np.concatenate([slope[:1], inner, slope[-1:]]))(time_ns)


class Hand:
    """What a hand should have got and what it got in each millisecond of a clip's own time, from first to last frame.

    `wanted`: rows of time, ns, and force, N, one for each frame. A millisecond is not `shown`, and has no force, if no tick
    of the playing clip is for it, or one whose frame is held or too old: the picture or the device stood still. Of a
    muted clip the trace does not tell how old a frame is.
    """

    def __init__(self, haptic_trace, wanted, is_muted):
        playing = [row for row in rows_of(haptic_trace) if row["playing"] == "1"]
        self.device, self.count = Counter(row["device"] for row in playing), len(playing)
        self.time_ns = np.arange(wanted[0][0], wanted[-1][0] + 1, MS_NS)
        self.wanted = (0 if is_muted else 1) * between(wanted, self.time_ns)
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


    def lag_ms(self):
        """By how much the delivered force is later than the wanted one; 0 where that is too little to be noticed."""
        def error(lag):
            count = len(self.wanted) - abs(lag)
            return root_mean_square(self.delivered[max(0, lag):][:count] - self.wanted[max(0, -lag):][:count])

        most = min(MOST_LAG_MS, len(self.wanted) // 4)
        errors = {lag: error(lag) for lag in range(-(most // STEP_MS) * STEP_MS, most + 1, STEP_MS)}
        best = min(errors, key=errors.get)
        unnoticed = min(error for lag, error in errors.items() if abs(lag) <= LATE_MS)
        return best if errors[best] < BETTER * unnoticed else 0

    def turned_deg(self):
        """Between wanted and delivered force, the median, by the square of the wanted one."""
        wanted, delivered = self.wanted[self.felt()], self.delivered[self.felt()]
        lengths = np.linalg.norm(wanted, axis=1) * np.linalg.norm(delivered, axis=1)
        if not lengths.any():
            return 0.0
        angles = np.arccos(np.clip((wanted * delivered).sum(axis=1)[lengths > 0] / lengths[lengths > 0], -1, 1))
        order, weights = np.argsort(angles), (wanted[lengths > 0]**2).sum(axis=1)
        reached = np.cumsum(weights[order])
        return float(np.degrees(angles[order][np.searchsorted(reached, reached[-1] / 2)]))

    def frozen(self):
        """Whether the delivered force stood at any level for MOST_STALL_MS while the wanted one moved."""
        if len(self.wanted) <= MOST_STALL_MS:
            return False
        moved = lambda force_N: np.linalg.norm(np.ptp(sliding_window_view(force_N, MOST_STALL_MS, axis=0), axis=-1), axis=1)
        wanted_N = moved(self.wanted)
        return bool(((wanted_N > FELT_N / 4) & (moved(self.delivered) < STANDS * wanted_N)).any())

    def nearness(self, other):
        """1 where the force is the wanted one, 0 where it is `other`, in the milliseconds in which a hand tells them apart;
        how strong it is as a whole does not matter as far as a hand does not notice."""
        other = between(other, self.time_ns)
        larger = np.maximum(np.linalg.norm(self.wanted, axis=1), np.linalg.norm(other, axis=1))
        apart = (larger >= FELT_N) & (np.linalg.norm(self.wanted - other, axis=1) > WEBER * larger) & self.shown
        if not apart.any():
            return 1.0
        wanted, other, delivered = self.wanted[apart], other[apart], self.delivered[apart]
        strength = np.clip((delivered * wanted).sum() / max(1e-9, (wanted**2).sum()), 1 - WEBER, 1 + WEBER)
        return float(((delivered / strength - other) * (wanted - other)).sum() / ((wanted - other)**2).sum())

    def buzz(self):
        """Amplitude, N, and band, Hz, of what is most above what a hand feels of a force that should not be there."""
        spectrum = lambda force_N: (abs(np.fft.rfft(force_N, axis=0))**2).sum(axis=1)
        hz = np.fft.rfftfreq(len(self.wanted), MS_NS / 1e9)
        # Both sides of the spectrum; the amplitude of a sine is √2 of its root mean square.
        amplitude = lambda power, band: 2 * math.sqrt(power[band].sum()) / len(self.wanted)
        more, asked, found = spectrum(self.delivered - self.wanted), spectrum(self.wanted), []
        for low, high in zip(BANDS_HZ, BANDS_HZ[1:]):
            band = (hz >= low) & (hz < high)
            amount_N = amplitude(more, band)
            found.append((amount_N - FELT_N - WEBER * amplitude(asked, band), amount_N, low, high))
        above, *most = max(found)
        return most if above > 0 else None


def root_mean_square(vectors):
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))


def cause(haptic_trace, frame_trace, lag_ms):
    """What the traces say of a force that did not come, in brackets, or nothing."""
    found = Counter(row["found"] for row in rows_of(haptic_trace) if row["playing"] == "1")
    reasons = [f"{abs(lag_ms)} ms too {'late' if lag_ms > 0 else 'early'}"] * (lag_ms != 0)
    reasons += [f"frames were late in {100 * found['expired'] / found.total():.0f} % of the time"] * (found["expired"] > 0)
    limits = Counter(row["device_no_force_reason"] for row in rows_of(frame_trace))
    limits.pop("none", None)
    reasons += [f"of the device or the playback: {limit}" for limit, _ in limits.most_common(1)]
    return f" ({', '.join(reasons)})" if reasons else ""


def judge(haptic_trace, frame_trace, wanted, is_muted, others=()):
    """The share of the force that was delivered, and what was wrong; nothing if the presentation was as it should be.

    `wanted`: of the clip with this condition, as its preview found it (`Hand`); `others`: with those that it is compared
    to. `is_muted`: there should be no force. A hand does not notice less than FELT_N, nor a change by less than WEBER.
    """
    hand = Hand(haptic_trace, wanted, is_muted)
    if hand.count == 0:
        return 0.0, "the device did not run while the clip played"
    share = 0.0 if is_muted else hand.share()
    lag_ms = 0 if is_muted else hand.lag_ms()
    because = cause(haptic_trace, frame_trace, lag_ms)
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
    if not is_muted:
        if lag_ms:
            return share, f"the force was not in time{because}"
        if hand.turned_deg() > TURNED_DEG:
            return share, f"the force was turned by {hand.turned_deg():.0f}°"
        if hand.frozen():
            return share, f"the force stood still for more than {MOST_STALL_MS} ms while it should move{because}"
        if min((hand.nearness(other) for other in others), default=1) < NEARER:
            return share, "the force was that of another condition as much as its own"
    if buzz := hand.buzz():
        return share, "there was a vibration of {:.3f} N at {} to {} Hz, and there should be none".format(*buzz)
    return share, ""
