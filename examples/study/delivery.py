# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether a hand got the force and torque that a presentation should have had, at the time of the picture, by its traces.

In each millisecond, what was delivered must be what was wanted as far as a hand can tell (perception.py). It may come
earlier or later than its picture by what is not noticed, but evenly: else all that a fast motion passes through would be
right at any time.
"""

import csv
import math
from collections import Counter

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d

from perception import FELT_N, FELT_NM, FROZEN_MS, LATE_MS, TURNED_DEG, WEBER, WEBER_OF_TORQUE

AXES = "xyz"
WRENCH = [f"{part}_{axis}_{unit}" for part, unit in (("force", "N"), ("torque", "Nm")) for axis in AXES]
MS_NS = 1_000_000
EVEN_MS = 200  # for so long one lag must fit, but for
JITTER_MS = 10  # by which ticks are late on a machine that is not real-time
MOST_LAG_MS, STEP_MS = 200, 5  # of the lags that are tried, to say why a force was wrong
BETTER = 0.8  # a lag is the reason if the force fits so much better with it
SHAKES_MS = 125  # and faster, 8 Hz, is a vibration: neither films nor filters ask for it


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def between(samples, time_ns):
    """Values at times between samples, which are rows of time and values: monotone, as the loop has them
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


def size(vectors):
    return np.linalg.norm(vectors, axis=-1)


def times_noticed(delivered, wanted):
    """By how many times more than is noticed each wrench differs from the wanted one: in strength, direction, torque."""
    force, torque = wanted[:, :3], wanted[:, 3:]
    amount_N = size(force)
    unit = force / np.maximum(amount_N, 1e-12)[:, None]
    along_N = (delivered[:, :3] * unit).sum(axis=1)
    across_N = size(delivered[:, :3] - along_N[:, None] * unit)
    return np.max([abs(along_N - amount_N) / np.maximum(FELT_N, WEBER * amount_N),
                   across_N / np.maximum(FELT_N, math.tan(math.radians(TURNED_DEG)) * amount_N),
                   size(delivered[:, 3:] - torque) / np.maximum(FELT_NM, WEBER_OF_TORQUE * size(torque))], axis=0)


class Pictures:
    """Which frame was on the screen when. `screen`: running_ns of each frame, and shown_ns, empty if it was dropped."""

    def __init__(self, wanted, ticks, screen):
        self.frames_ns = [wanted[0][0]]
        for time_ns, *_ in wanted[1:-1]:  # of the motion, halfway since the frame before; the last row is the clip's end
            self.frames_ns.append(2 * time_ns - self.frames_ns[-1])
        self.shown = np.array(sorted([[int(row["running_ns"]), int(row["shown_ns"])] for row in screen if row["shown_ns"]],
                                     key=lambda frame: frame[1]) or [[0, 2**62]])
        self.ticks = ticks
        self.frame_ms = float(np.median(np.diff(self.frames_ns))) / MS_NS if len(self.frames_ns) > 1 else 0

    def stood_ms(self):
        """For how long one was on the screen, at most."""
        ends_ns = self.ticks["monotonic_ns"][0], self.ticks["monotonic_ns"][-1] - self.frame_ms * MS_NS
        return np.diff([ends_ns[0], *self.shown[:, 1], ends_ns[1]]).max() / MS_NS

    def lag_ms(self):
        """For each tick, by how much the picture on the screen is behind it (or, below 0, ahead of it) in the clip."""
        newest = np.searchsorted(self.shown[:, 1], self.ticks["monotonic_ns"], side="right") - 1
        on_screen_ns = np.where(newest >= 0, self.shown[newest, 0], -MS_NS)
        next_ns = np.append(self.frames_ns, 2**62)[np.searchsorted(self.frames_ns, on_screen_ns + MS_NS // 2)]
        running_ns = self.ticks["running_ns"]
        return ((np.maximum(0, running_ns - next_ns) + np.minimum(0, running_ns - on_screen_ns)) / MS_NS).astype(int)

    def drift_ms(self):
        """By how much the time of the clip and the clock went apart, of ticks or pictures: it is as long as it should be, and
        evenly so."""
        return max(np.ptp(self.ticks["monotonic_ns"] - self.ticks["running_ns"]), np.ptp(self.shown[:, 1] - self.shown[:, 0])) / MS_NS

    def stray_ms(self):
        """How far a picture is from those of the preview."""
        return np.abs(np.subtract.outer(self.frames_ns, self.shown[:, 0])).min(axis=0).max() / MS_NS


class Hand:
    """What a hand should have got and what it got in each millisecond of a clip's own time, from first to last frame.

    `wanted`: rows of time, ns, and wrench, one for each frame. What a tick delivers lasts until the next one that the
    device has acknowledged.
    """

    def __init__(self, haptic_trace, screen_trace, wanted, is_muted):
        playing = [row for row in rows_of(haptic_trace) if row["playing"] == "1"]
        self.device, self.count = Counter(row["device"] for row in playing), len(playing)
        playing = sorted((row for row in playing if row["acknowledged"] == "1"), key=lambda row: int(row["running_ns"]))
        if not playing:
            self.count = 0
            return
        self.ticks = {name: np.array([int(row[name]) for row in playing]) for name in ("running_ns", "monotonic_ns")}
        self.found = np.array([row["found"] for row in playing])
        self.time_ns = np.arange(wanted[0][0], wanted[-1][0] + 1, MS_NS)
        self.wanted = (0 if is_muted else 1) * between(wanted, self.time_ns)
        self.newest = np.maximum(np.searchsorted(self.ticks["running_ns"], self.time_ns + MS_NS, side="left") - 1, 0)
        wrenches = np.array([[float(row[f"delivered_{name}"]) for name in WRENCH] for row in playing])
        self.delivered = np.nan_to_num(wrenches, nan=1e9)[self.newest]  # what is no number is surely noticed
        self.pictures = Pictures(wanted, self.ticks, rows_of(screen_trace))
        self.picture_lag_ms = self.pictures.lag_ms()[self.newest]

    def later(self, lag_ms, wrenches=None):
        """The wanted wrench, or another one, so much later."""
        at = np.clip(np.arange(len(self.wanted)) - lag_ms, 0, len(self.wanted) - 1)
        return (self.wanted if wrenches is None else wrenches)[at]

    def unnoticed_lag_ms(self):
        """Of those that nobody notices, the one with which the force fits best."""
        return max(range(-LATE_MS, LATE_MS + 1, STEP_MS),
                   key=lambda lag: (self.later(lag)[:, :3] * self.delivered[:, :3]).sum())

    def share(self):
        """The part of the wanted force that came, in its direction; 1 if none is to be felt."""
        if size(self.wanted[:, :3]).max() < FELT_N:
            return 1.0
        wanted = self.later(self.unnoticed_lag_ms())[:, :3]
        return float(np.clip((wanted * self.delivered[:, :3]).sum() / (self.wanted[:, :3]**2).sum(), -1, 1))

    def waited_ms(self, part=slice(None)):
        """The longest time without a tick, of the clip and of the clock."""
        newest = self.newest[part]
        ages_ns = abs(self.time_ns[part] - self.ticks["running_ns"][newest])
        gaps_ns = np.diff(self.ticks["monotonic_ns"][newest[0]:newest[-1] + 2])
        return max(ages_ns.max(), gaps_ns.max(initial=0)) / MS_NS

    def noticed(self):
        """times_noticed() around each millisecond, of the picture on the screen, with the lag that fits best."""
        reach = LATE_MS + JITTER_MS
        times = np.stack([times_noticed(self.delivered, self.later(self.picture_lag_ms + lag)) for lag in range(-reach, reach + 1)])
        times = minimum_filter1d(times, 2 * JITTER_MS + 1, axis=0)[JITTER_MS:-JITTER_MS]
        return maximum_filter1d(times, EVEN_MS, axis=1).min(axis=0)

    def lag_ms(self):
        """By how much the delivered force is later than the wanted one; 0 where that is too little to be noticed."""
        errors = {lag: size((self.delivered - self.later(lag))[:, :3]).mean() for lag in
                  range(-MOST_LAG_MS, MOST_LAG_MS + 1, STEP_MS)}
        best = min(errors, key=errors.get)
        unnoticed = min(error for lag, error in errors.items() if abs(lag) <= LATE_MS)
        return best if errors[best] < BETTER * unnoticed else 0

    def nearness(self, other):
        """1 where the force is the wanted one, 0 where it is `other`, in the milliseconds in which a hand tells them apart;
        how strong it is as a whole does not matter as far as a hand does not notice."""
        lag_ms, delivered = self.unnoticed_lag_ms(), self.delivered[:, :3]
        wanted, other = self.later(lag_ms)[:, :3], self.later(lag_ms, between(other, self.time_ns))[:, :3]
        larger = np.maximum(size(wanted), size(other))
        apart = (larger >= FELT_N) & (size(wanted - other) > WEBER * larger)
        if not apart.any():
            return 1.0
        wanted, other, delivered = wanted[apart], other[apart], delivered[apart]
        strength = np.clip((delivered * wanted).sum() / max(1e-9, (wanted**2).sum()), 1 - WEBER, 1 + WEBER)
        return float(((delivered / strength - other) * (wanted - other)).sum() / ((wanted - other)**2).sum())

    def shakes_N(self):
        """The largest amplitude of what is faster than SHAKES_MS and that the film does not ask for, over four times that."""
        def amplitude(force_N):
            fast = force_N - uniform_filter1d(force_N, SHAKES_MS, axis=0)
            return np.sqrt(2 * np.maximum(0, uniform_filter1d((fast**2).sum(axis=1), 4 * SHAKES_MS)))

        asked = maximum_filter1d(amplitude(self.wanted[:, :3]), 2 * SHAKES_MS)
        return float((amplitude(self.delivered[:, :3]) - (1 + WEBER) * asked).max())


def cause(hand, frame_trace, part):
    """What the traces say of a force that was not right in a part of the clip, in brackets, or nothing."""
    lag_ms = hand.lag_ms() if hand.wanted.any() else 0
    reasons = [f"{abs(lag_ms)} ms too {'late' if lag_ms > 0 else 'early'}"] * (lag_ms != 0)
    for what, amount_ms in (("the picture stood for", hand.picture_lag_ms[part].max()), ("no tick came for", hand.waited_ms(part)),
                            ("the picture was ahead for", -hand.picture_lag_ms[part].min())):
        reasons += [f"{what} {amount_ms:.0f} ms too long"] if amount_ms > JITTER_MS else []
    late = np.isin(hand.found[hand.newest[part]], ("held", "expired")).mean()
    reasons += [f"frames were late in {100 * late:.0f} % of that time"] * bool(late)
    limits = Counter(row["device_no_force_reason"] for row in rows_of(frame_trace))
    limits.pop("none", None)
    reasons += [f"of the device or the playback: {limit}" for limit, _ in limits.most_common(1)]
    return f" ({', '.join(reasons)})" if reasons else ""


def judge(haptic_trace, frame_trace, screen_trace, wanted, is_muted, others=()):
    """The share of the force that was delivered, and what was wrong; nothing if the presentation was as it should be.

    `wanted`: of the clip with this condition, as its preview found it (`Hand`); `others`: with those that it is compared
    to. `is_muted`: there should be no force.
    """
    hand = Hand(haptic_trace, screen_trace, wanted, is_muted)
    if hand.count == 0:
        return 0.0, "the device did not run while the clip played"
    share = 0.0 if is_muted else hand.share()
    not_running = 1 - hand.device["running"] / hand.count
    if not_running > WEBER:
        state = (hand.device - Counter(running=hand.count)).most_common(1)[0][0]
        return share, f"the device was {state} in {100 * not_running:.0f} % of the time"
    pictures = hand.pictures
    of_time = ((pictures.stood_ms(), max(FROZEN_MS, 2 * pictures.frame_ms), "the picture stood still for {:.0f} ms"),
               (hand.waited_ms(), FROZEN_MS, "the device stood still, or was elsewhere in the clip, for {:.0f} ms"),
               (pictures.drift_ms(), FROZEN_MS, "the clip was longer or shorter than it should be by {:.0f} ms"),
               (pictures.stray_ms(), JITTER_MS, "a picture came {:.0f} ms from where the preview has one"))
    if wrong := [said.format(amount_ms) for amount_ms, most_ms, said in of_time if amount_ms > most_ms]:
        return share, "; ".join(wrong)
    noticed = hand.noticed()
    worst = int(noticed.argmax())
    if noticed[worst] > 1 or share < 1 - WEBER and not is_muted:
        part = slice(max(0, worst - EVEN_MS), worst + EVEN_MS)
        return share, (f"{100 * share:.0f} % of the clip's force was delivered, and at {worst / 1000:.1f} s it was "
                       f"{noticed[worst]:.1f} times as far from what it should be as is noticed{cause(hand, frame_trace, part)}")
    if not is_muted and min((hand.nearness(other) for other in others), default=1) < 1 - WEBER:
        return share, "the force was in part that of another condition"
    if hand.shakes_N() > FELT_N:
        return share, f"there was a vibration of {hand.shakes_N():.3f} N that the film does not ask for"
    return share, ""
