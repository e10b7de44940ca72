# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether the answers to two conditions differ, for other people than those of the study, and for other clips if it has many.

d_pc, the difference of the answers of participant p for clip c, is μ + a_p + b_c + e_pc: people differ in their effect, and
so do clips. Below MANY_CLIPS, what is said is of these clips: the mean of each person is one of a sample, and how clips
differ does not matter. From there on, clips are a sample, too: the mean of all d has the variance (MS_P + MS_C − MS_E) /
(P C), with the degrees of freedom of Satterthwaite: the quasi-F of H. Clark, The Language-as-Fixed-Effect Fallacy, 1973. It
is the estimate of a linear mixed model by restricted maximum likelihood, as MixedLM of statsmodels and lmerTest of R have
it. No statistic tells from few clips what some of the others are like: where one in five carries the effect, 6 clips and
120 people would miss the difference of all clips in one study of five.

Answers that are missing (NaN) are filled in with what the person and the clip would give, and taken from the degrees of
freedom of e (F. Allan, J. Wishart, A Method of Estimating the Yield of a Missing Plot in Field Experimental Work, 1930; of
several, by iteration, F. Yates, 1933).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.stats import norm, t

MANY_CLIPS = 12
FIRST_PEOPLE = 4  # who tell nothing yet: t is no normal deviate. With them, looks after each of 24 people err in 5.5 %
FARTHEST = 8  # standard deviations, of a bound
NODES, WEIGHTS = np.polynomial.legendre.leggauss(301)  # more change no level of 48 looks by 1e-6
FILLS = 30  # times; each brings the values nearer by the part that is missing of a row and of a column


@dataclass
class Difference:
    """In steps of the scale, of one study or of many (arrays). `error` is 0 where no two answers tell how much people or
    clips differ."""
    mean: float
    error: float
    freedom: float

    def tail(self, distance):
        """Of how many studies the error is at least so much, on one side; not below half where there is no error."""
        error = np.where(self.error > 0, self.error, 1)
        return np.where(self.error > 0, t.sf(distance / error, self.freedom), 1)[()]

    def p(self):
        """Of no difference, two-sided."""
        return np.minimum(1, 2 * self.tail(np.abs(self.mean)))

    def p_of_equivalence(self, margin):
        """Of a difference of at least `margin` either way: the larger of two one-sided tests."""
        return self.tail(margin - np.abs(self.mean))

    def interval(self, level=0.95):
        half = np.where(self.error > 0, t.ppf(0.5 + level / 2, self.freedom) * self.error, np.inf)[()]
        return self.mean - half, self.mean + half


def filled(d):
    """Without NaN, and how many there were of each study."""
    missing, d = np.isnan(d), d.copy()
    d[missing] = np.broadcast_to(np.nanmean(np.where(missing, np.nan, d), axis=(-2, -1), keepdims=True), d.shape)[missing]
    for _ in range(FILLS if missing.any() else 0):
        additive = d.mean(axis=-1, keepdims=True) + d.mean(axis=-2, keepdims=True) - d.mean(axis=(-2, -1), keepdims=True)
        d[missing] = additive[missing]
    return d, missing.sum(axis=(-2, -1))


def difference(differences):
    """`differences`: a row for each participant, a column for each clip, or a stack of such studies; NaN is missing."""
    d, missing = filled(np.asarray(differences, float))
    people, clips = d.shape[-2:]
    mean = d.mean(axis=(-2, -1))
    if people < 2:
        return Difference(mean, 0 * mean, 1 + 0 * mean)
    center, by_person, by_clip = mean[..., None, None], d.mean(axis=-1, keepdims=True), d.mean(axis=-2, keepdims=True)
    freedoms = people - 1, max(1, clips - 1), np.maximum(1, (people - 1) * max(1, clips - 1) - missing)
    squares = lambda values, weight, freedom: weight * (values**2).sum(axis=(-2, -1)) / freedom
    of_people = squares(by_person - center, clips, freedoms[0])
    if clips < MANY_CLIPS:
        return Difference(mean, np.sqrt(of_people / (people * clips)), freedoms[0] + 0 * mean)
    of_clips = squares(by_clip - center, people, freedoms[1])
    rest = squares(d - by_person - by_clip + center, 1, freedoms[2])
    # A variance is not negative. Where it would be, people or clips do not differ in their effect.
    alike = of_clips <= rest
    of_clips, rest = np.where(alike, 0, of_clips), np.where(alike, 0, rest)
    alike = of_people <= rest
    of_people, rest = np.where(alike, 0, of_people), np.where(alike, 0, rest)
    total = of_people + of_clips - rest
    spread = sum(square**2 / freedom for square, freedom in zip((of_people, of_clips, rest), freedoms))
    freedom = np.where(total > 0, total**2 / np.where(spread > 0, spread, 1), 1)
    return Difference(mean, np.sqrt(np.maximum(0, total) / (people * clips)), freedom)


def holm(values):
    """p-values, corrected for their number (S. Holm, 1979)."""
    corrected, largest = [0.0] * len(values), 0.0
    for rank, place in enumerate(sorted(range(len(values)), key=values.__getitem__)):
        largest = max(largest, min(1.0, (len(values) - rank) * values[place]))
        corrected[place] = largest
    return corrected


def levels(looks, planned, level):
    """At which p looks at the answers of so many people (rising) are significant, of so many who are planned, so that all looks
    together err in `level` of the studies: the function of K. Lan and D. DeMets (Discrete Sequential Boundaries for Clinical
    Trials, 1983) that is nearly the bounds of O'Brien and Fleming, two-sided. The sum of the answers is a Brownian motion, whose
    density inside the bounds is integrated from look to look."""
    spent = lambda part: 4 * norm.sf(norm.isf(level / 4) / math.sqrt(part)) if part else 0.0
    found, places, shares, before = [], np.zeros(1), np.ones(1), 0
    for now in (1 if people >= planned else max(0, people - FIRST_PEOPLE) / max(1, planned - FIRST_PEOPLE)
                for people in looks):
        if now == before:
            found.append(0.0)
            continue
        step, most, spend = math.sqrt(now - before), FARTHEST * math.sqrt(now), spent(now) - spent(before)
        beyond = lambda bound: shares @ (norm.sf((bound - places) / step) + norm.sf((bound + places) / step)) - spend
        bound = brentq(beyond, 0, most) if beyond(most) < 0 else most  # so early, nothing is spent
        found.append(2 * norm.sf(bound / math.sqrt(now)) if bound < most else 0.0)
        shares, places, before = shares @ norm.pdf(bound * NODES, places[:, None], step) * bound * WEIGHTS, bound * NODES, now
    return found
