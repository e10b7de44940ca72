#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints how often the analysis of the study errs, in simulated studies (examples/study/plan.py):

  tests/bench/study_errors.py [STUDIES]      of each kind, 4000 if not given

false: how often a difference is found at a level of 5 % where there is none. covered: how often the 95 % interval has
the true difference, of an odds ratio of 1 and of 7. equal: how often two conditions that differ by just the margin of
equivalence are called equal at 5 %; there the true difference is taken as the margin. People differ by a standard
deviation of 1 in level and effect, clips by the one given (log odds)."""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "study"))

import numpy as np  # noqa: E402

import plan  # noqa: E402

DESIGNS = [(12, 3), (12, 6), (24, 4), (24, 6), (48, 6), (24, 12)]  # participants, clips
CLIP_SPREADS = (0, 0.8)
LOG_ODDS = math.log(7)


def main():
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
    print("| participants | clips | spread of clips | false % | covered % (no effect) | covered % (odds ratio 7) "
          "| equal % |\n" + "|---" * 7 + "|")
    for people, clips in DESIGNS:
        for clip_spread in CLIP_SPREADS:
            random = np.random.default_rng(1)
            found = {log_odds: [plan.difference_of(plan.made_answers(random, people, clips, log_odds, 1, clip_spread))
                                for _ in range(studies)] for log_odds in (0, LOG_ODDS)}
            share = lambda each: f"{100 * sum(each) / studies:.1f}"
            true = {log_odds: plan.true_difference(log_odds, 1, clip_spread) for log_odds in found}
            covered = {log_odds: share(low < true[log_odds] < high for low, high in (each.interval() for each in all_))
                       for log_odds, all_ in found.items()}
            print(f"| {people} | {clips} | {clip_spread:g} | {share(each.p() < 0.05 for each in found[0])} | {covered[0]} "
                  f"| {covered[LOG_ODDS]} | {share(each.p_of_equivalence(true[LOG_ODDS]) < 0.05 for each in found[LOG_ODDS])} |",
                  flush=True)


if __name__ == "__main__":
    main()
