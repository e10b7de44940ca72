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
    """To the right, with ramps. Raises RuntimeError if the device takes no force."""
    for n in range(round((PULSE_S + 2 * RAMP_S) / SAMPLE_S) + 1):
        edge_s = min(n * SAMPLE_S, PULSE_S + 2 * RAMP_S - n * SAMPLE_S)
        share = 0.5 - 0.5 * math.cos(math.pi * min(1, edge_s / RAMP_S))
        if not device.push((force_N * share, 0, 0)):
            raise RuntimeError(f"the device takes no force: {device.last_fault()}")
        sleep(SAMPLE_S)


def measure(device, standard_N, staircase, ask, source=random, sleep=time.sleep):
    """The level at which `standard_N` · (1 + level) is felt to be stronger than it, or `level` N than none if it is 0.

    `ask()`: in which of two pulses the force was the larger one, 1 or 2.
    """
    while not staircase.is_done():
        larger_N = standard_N * (1 + staircase.level) if standard_N else staircase.level
        larger = source.choice((1, 2))
        for interval in 1, 2:
            pulse(device, larger_N if interval == larger else standard_N, sleep)
            sleep(PAUSE_S)
        staircase.answer(ask() == larger)
    return staircase.threshold()
