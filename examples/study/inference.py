# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether the answers to two conditions differ, for other people and other clips than those of the study.

d_pc, the difference of the answers of participant p for clip c, is μ + a_p + b_c + e_pc: people differ in their effect, and
so do clips, and both are samples. Every participant sees every clip, so that the mean of all d has the variance
(MS_P + MS_C − MS_E) / (P C), with the degrees of freedom of Satterthwaite: the quasi-F of H. Clark, The
Language-as-Fixed-Effect Fallacy, 1973. It is the estimate of a linear mixed model by restricted maximum likelihood, as
MixedLM of statsmodels gives it, but that, as clmm of R's package ordinal, takes the normal distribution for the interval
however few the clips are.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import t


@dataclass
class Difference:
    """In steps of the scale. `error` is None where no two answers tell how much people or clips differ."""
    mean: float
    error: float
    freedom: float

    def p(self):
        """Of no difference, two-sided."""
        return 1.0 if self.error is None else 2 * t.sf(abs(self.mean) / self.error, self.freedom)

    def p_of_equivalence(self, margin):
        """Of a difference of at least `margin` either way: the larger of two one-sided tests."""
        return 1.0 if self.error is None else t.sf((margin - abs(self.mean)) / self.error, self.freedom)

    def interval(self, level=0.95):
        half = np.inf if self.error is None else t.ppf(0.5 + level / 2, self.freedom) * self.error
        return self.mean - half, self.mean + half


def difference(differences):
    """`differences`: a row for each participant, a column for each clip. A single clip says nothing of others."""
    d = np.asarray(differences, float)
    people, clips = d.shape
    mean = d.mean()
    if people < 2:
        return Difference(mean, None, 0)
    by_person, by_clip = d.mean(axis=1, keepdims=True), d.mean(axis=0)
    of_people = clips * ((by_person - mean)**2).sum() / (people - 1)
    if clips == 1:
        squares, freedoms = [of_people], [people - 1]
    else:
        of_clips = people * ((by_clip - mean)**2).sum() / (clips - 1)
        rest = ((d - by_person - by_clip + mean)**2).sum() / ((people - 1) * (clips - 1))
        squares, freedoms = [of_people, of_clips, -rest], [people - 1, clips - 1, (people - 1) * (clips - 1)]
        # A variance is not negative. Where it would be, people or clips do not differ in their effect.
        if of_clips <= rest:
            squares, freedoms = [of_people], [people - 1]
        elif of_people <= rest:
            squares, freedoms = [of_clips], [clips - 1]
    total = sum(squares)
    if not total > 0:
        return Difference(mean, None, 0)
    freedom = total**2 / sum(square**2 / n for square, n in zip(squares, freedoms))
    return Difference(mean, np.sqrt(total / d.size), freedom)


def holm(values):
    """p-values, corrected for their number (S. Holm, 1979)."""
    corrected, largest = [0.0] * len(values), 0.0
    for rank, place in enumerate(sorted(range(len(values)), key=values.__getitem__)):
        largest = max(largest, min(1.0, (len(values) - rank) * values[place]))
        corrected[place] = largest
    return corrected
