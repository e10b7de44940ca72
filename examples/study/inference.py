# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether the answers to two conditions differ, for other people and other clips than those of the study.

d_pc, the difference of the answers of participant p for clip c, is μ + a_p + b_c + e_pc: people differ in their effect, and
so do clips, and both are samples. Every participant sees every clip, so that the mean of all d has the variance
(MS_P + MS_C − MS_E) / (P C), with the degrees of freedom of Satterthwaite: the quasi-F of H. Clark, The
Language-as-Fixed-Effect Fallacy, 1973. It is the estimate of a linear mixed model by restricted maximum likelihood, as
MixedLM of statsmodels gives it, but that, as clmm of R's package ordinal, takes the normal distribution for the interval
however few the clips are. MS_E is not subtracted below FEW_CLIPS (min F', of the same paper): whether so few clips differ,
they do not tell, and studies of 24 people and 3 clips would find a difference where there is none in 6.0 % instead of 3.7 %.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import t

FEW_CLIPS = 4


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


def difference(differences):
    """`differences`: a row for each participant, a column for each clip, or a stack of such studies. A single clip says
    nothing of others."""
    d = np.asarray(differences, float)
    people, clips = d.shape[-2:]
    mean = d.mean(axis=(-2, -1))
    if people < 2:
        return Difference(mean, 0 * mean, 1 + 0 * mean)
    center, by_person, by_clip = mean[..., None, None], d.mean(axis=-1, keepdims=True), d.mean(axis=-2, keepdims=True)
    freedoms = people - 1, max(1, clips - 1), (people - 1) * max(1, clips - 1)
    squares = lambda values, weight, freedom: weight * (values**2).sum(axis=(-2, -1)) / freedom
    of_people = squares(by_person - center, clips, freedoms[0])
    of_clips = squares(by_clip - center, people, freedoms[1])
    rest = squares(d - by_person - by_clip + center, 1, freedoms[2])
    if clips < FEW_CLIPS:
        rest = 0 * rest
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
