#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints how often the study errs, in simulated studies and of simulated people (examples/study/):

  tests/bench/study_errors.py [STUDIES]      of each kind, 4000 if not given

false: how often a difference is found at a level of 5 % where there is none. covered: how often the 95 % interval has
the true difference, of an odds ratio of 1 and of 7. equal: how often two conditions that differ by just the margin of
equivalence are called equal at 5 %; there the true difference is taken as the margin. shown: how often conditions that
are equal are found to be, within half a step. People differ by a standard deviation of 1 in level and effect, clips by
the one given (log odds). Then, how far thresholds (`study.py threshold`) are from those of simulated people; who lapses in
100 % of the trials guesses."""

import math
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "study"))

import numpy as np  # noqa: E402

import perception  # noqa: E402
import plan  # noqa: E402

DESIGNS = [(24, 2), (12, 3), (24, 3), (36, 3), (12, 6), (24, 4), (24, 6), (48, 6), (24, 12), (120, 12)]  # participants, clips
CLIP_SPREADS = (0, 0.8)
LOG_ODDS = math.log(7)
AT_ONCE = 500
TRUE_N = 0.05  # a threshold, at which 70.7 % are right


def simulated(source, studies, *design):
    """Of the studies of a design: false, covered, equal and shown."""
    true = plan.true_difference(design[2], *design[3:])
    parts = []
    for begin in range(0, studies, AT_ONCE):
        found = plan.difference_of(plan.made_answers(source, *design, (min(AT_ONCE, studies - begin),)))
        low, high = found.interval()
        parts.append([found.p() < 0.05, (low < true) & (true < high), found.p_of_equivalence(true) < 0.05,
                      found.p_of_equivalence(0.5) < 0.05])
    return [f"{100 * np.concatenate(each).mean():.1f}" for each in zip(*parts)]


def thresholds(people):
    """Of simulated people by slope and lapses: how many get a threshold, its bias, and its scatter."""
    print("\n| slope | lapses | threshold found % | bias | SD (ln) | trials |\n" + "|---" * 6 + "|")
    for slope, lapses in (1.5, 0), (1.5, 0.05), (3, 0), (3, 0.05), (3, 0.1), (4.5, 0), (3, 1):
        source, logs, trials = random.Random(1), [], []
        for _ in range(people):
            stairs = perception.Staircase(0.25, 1.0)
            while not stairs.is_done():
                certain = 1 - 0.5 * math.exp(math.log(2 - math.sqrt(2)) * (stairs.level / TRUE_N)**slope)
                stairs.answer(source.random() < lapses / 2 + (1 - lapses) * certain)
            trials.append(stairs.trials)
            logs += [math.log(stairs.threshold() / TRUE_N)] if stairs.threshold() else []
        bias, scatter = (f"× {math.exp(np.mean(logs)):.2f}", f"{np.std(logs):.2f}") if len(logs) > people / 10 else ("–", "–")
        print(f"| {slope:g} | {100 * lapses:g} % | {100 * len(logs) / people:.0f} | {bias} | {scatter} | {np.mean(trials):.0f} |",
              flush=True)


def main():
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
    print("| participants | clips | spread of clips | false % | covered % (no effect) | covered % (odds ratio 7) "
          "| equal % | shown % |\n" + "|---" * 8 + "|")
    for people, clips in DESIGNS:
        for clip_spread in CLIP_SPREADS:
            source = np.random.default_rng(1)
            false, none, _, shown = simulated(source, studies, people, clips, 0, 1, clip_spread)
            _, seven, equal, _ = simulated(source, studies, people, clips, LOG_ODDS, 1, clip_spread)
            print(f"| {people} | {clips} | {clip_spread:g} | {false} | {none} | {seven} | {equal} | {shown} |", flush=True)
    thresholds(max(50, studies // 20))


if __name__ == "__main__":
    main()
