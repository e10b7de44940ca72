# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What a hand can tell: the least force, the least change of it, and how a person's own are measured on the device."""

import math
import random
import time

import numpy as np

# Of forces that were attended to (docs/bibliography.md): the least that is felt, and the least change of it, PubMed
# 24808327; with a picture that moves as they do, their delay (Vogels) and their direction (Barbagli).
FELT_N, WEBER, LATE_MS, TURNED_DEG = 0.04, 0.11, 45, 18.4
# Of a torque, the least change (Jandura), and as the least one, that of FELT_N at the surface of a grip, whose radius is
# 22.5 mm: kTorqueArm_m of core/force. A knob's is 0.1 to 8 mN m (Yang).
WEBER_OF_TORQUE, FELT_NM = 0.127, 0.0225 * FELT_N
FROZEN_MS = 100  # viewers see from 80 to 200 ms on that a picture stands still (AVEQ)
THRESHOLDS = ("felt_N", "weber", "turned_deg", "late_ms")  # the same four of a person, as they are measured and kept

# A staircase whose level falls after two right answers and rises after a wrong one settles where 70.7 % are right.
# H. Levitt, Transformed Up-Down Methods in Psychoacoustics, 1971.
FIRST_FACTOR, FACTOR = 2.0, 2**(1 / 3)  # of a step, until and after the second reversal
REVERSALS = 6  # at least
MOST_TRIALS = 60  # of three seconds
# Of the curve from guessing to certainty (Weibull) any of these may be anybody's; a lapse is answered by guessing.
SLOPES, LAPSES = (1.5, 2, 3, 4.5), (0, 0.03, 0.1)
WIDEST = 4  # times from the low to the high end of a threshold's 95 % interval; beyond, it is none
SAMPLE_S, RAMP_S, PULSE_S, PAUSE_S = 0.005, 0.1, 0.5, 0.4  # without a ramp, a pulse begins with a tap


def told_apart(pairs_N, felt_N=FELT_N, weber=WEBER):
    """`pairs_N`: two forces of each frame. The share of frames in which one is felt, of these the differences as parts of
    the larger one, and the share that differ by more than the Weber fraction."""
    felt = [pair for pair in pairs_N if max(pair) >= felt_N]
    differences = [abs(first - second) / max(first, second) for first, second in felt]
    return (len(felt) / len(pairs_N), differences,
            sum(each > weber for each in differences) / len(felt) if felt else 0.0)


class Staircase:
    """Two down, one up, by factors; `level` is what to show next. It places the trials; the threshold is estimated from
    all answers."""

    def __init__(self, first, most):
        self.level, self.most = first, most
        self.right, self.direction, self.turns = 0, -1, 0
        self.thresholds = most * np.geomspace(1e-3, 4, 200)
        thresholds, slopes, self.lapses = np.meshgrid(self.thresholds, SLOPES, LAPSES, indexing="ij")
        self.curve = lambda level: self.lapses / 2 + (1 - self.lapses) * (
            1 - 0.5 * np.exp(math.log(2 - math.sqrt(2)) * (level / thresholds)**slopes))
        self.likelihood, self.trials = np.ones(thresholds.shape), 0

    def answer(self, is_right):
        chance = self.curve(self.level)
        self.likelihood *= chance if is_right else 1 - chance
        self.likelihood /= self.likelihood.max()
        self.trials += 1
        self.right = self.right + 1 if is_right else 0
        if is_right and self.right < 2:
            return
        self.right, direction = 0, -1 if is_right else 1
        self.turns += direction != self.direction
        self.direction = direction
        self.level = min(self.most, self.level * (FIRST_FACTOR if self.turns < 2 else FACTOR)**direction)

    def quantiles(self):
        """Of the threshold: the ends of its 95 % interval and the median between them."""
        below = np.cumsum(self.likelihood.sum(axis=(1, 2)))
        return [self.thresholds[np.searchsorted(below, share * below[-1])] for share in (0.025, 0.5, 0.975)]

    def is_known(self):
        low, _, high = self.quantiles()
        return high <= self.most and high <= WIDEST * low

    def is_done(self):
        return (self.turns >= REVERSALS and self.is_known()) or self.trials >= MOST_TRIALS

    def threshold(self):
        """None if the answers do not tell it, as when somebody guesses."""
        return float(self.quantiles()[1]) if self.is_known() else None


def pulse(device, force_N, sleep=time.sleep):
    """`force_N`: along x, or a vector; with ramps. Raises RuntimeError if the device takes no force."""
    vector_N = np.array([force_N, 0, 0]) if np.isscalar(force_N) else np.asarray(force_N, float)
    for n in range(round((PULSE_S + 2 * RAMP_S) / SAMPLE_S) + 1):
        if not device.push(tuple(share_of_pulse(n * SAMPLE_S) * vector_N)):
            raise RuntimeError(f"the device takes no force: {device.last_fault()}")
        sleep(SAMPLE_S)


def share_of_pulse(time_s):
    """Of its force, so long after it began."""
    edge_s = min(max(0, min(time_s, PULSE_S + 2 * RAMP_S - time_s)), RAMP_S)
    return 0.5 - 0.5 * math.cos(math.pi * edge_s / RAMP_S)


def blocks(device, limit_N, picture, sleep=time.sleep):
    """Of each threshold, by its column: its staircase, how one of two intervals is presented, at a level or at 0, and what
    is asked. `picture`: a MovingSquare, of the synchrony."""
    standard_N = limit_N / 2  # so that twice of it is within

    def turned(level_deg):
        angle = math.radians(level_deg)
        pulse(device, (standard_N * math.cos(angle), standard_N * math.sin(angle), 0), sleep)

    def late(level_ms):
        picture.move(lambda begin_ns: (sleep_until(begin_ns + level_ms * 1e6), pulse(device, standard_N, sleep)))

    return {
        "felt_N": (Staircase(0.25 * limit_N, limit_N), lambda level_N: pulse(device, level_N, sleep),
                   "When was the force larger?"),
        "weber": (Staircase(0.5, 1.0), lambda level: pulse(device, standard_N * (1 + level), sleep),
                  "When was the force larger?"),
        "turned_deg": (Staircase(45, 90), turned, "When did the force point higher?"),
        "late_ms": (Staircase(200, 400), late, "When did the force come later than the square moved?")}


def sleep_until(time_ns):
    time.sleep(max(0, time_ns - time.monotonic_ns()) / 1e9)


def measure(present, staircase, ask, source=random, sleep=time.sleep):
    """The level of `staircase` at which `present(level)` is told from `present(0)`.

    `ask()`: which of two intervals had the level, 1 or 2.
    """
    while not staircase.is_done():
        larger = source.choice((1, 2))
        for interval in 1, 2:
            present(staircase.level if interval == larger else 0)
            sleep(PAUSE_S)
        staircase.answer(ask() == larger)
    return staircase.threshold()
