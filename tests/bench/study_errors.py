#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Prints how often the study errs, in simulated studies and of simulated people (examples/study/):

  tests/bench/study_errors.py [STUDIES]      of each kind, 4000 if not given

How often the 95 % interval misses the true difference, which is that of the clips of the study if these are few, and of all
clips if they are many (inference.py); of clips that are alike and have no effect, that differ (log odds with a standard
deviation of 0.8), and of which one in five has an odds ratio of 7 and the others have none. 3 % missing: of the last, where
so many answers are. equal: how often two conditions that differ by just the margin of equivalence, the true difference of
the last, are called equal at 5 %. shown: how often conditions that are equal are found to be, within half a step. People
differ by a standard deviation of 1 in level and effect. Then, of 24 people and 6 clips, how often any of several looks at the
answers finds a difference at 5 % where there is none, and how often where the odds ratio is 3: each look by itself, and by
the levels of inference.py. Last, how far thresholds (`study.py threshold`) are from those of
simulated people; who lapses in 100 % of the trials guesses."""

import math
import random
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "study"))

import numpy as np  # noqa: E402

import inference  # noqa: E402
import perception  # noqa: E402
import plan  # noqa: E402

DESIGNS = [(12, 2), (24, 3), (12, 4), (24, 6), (120, 6), (24, 12), (48, 12), (120, 12), (24, 20), (120, 20)]  # people, clips
MANY = 200_000  # clips, whose mean difference is that of all
LOG_ODDS = math.log(7)
MISSING = 0.03
AT_ONCE = 500
TRUE_N = 0.05  # a threshold, at which 70.7 % are right


def alike(source, shape):
    return np.zeros(shape)


def differ(source, shape):
    return source.normal(0, 0.8, shape)


def few_carry_it(source, shape):
    return np.where(source.random(shape) < 0.2, LOG_ODDS, 0)


def made_clips(source, effect, shape):
    """Level and effect, log odds."""
    return (np.zeros(shape) if effect is alike else differ(source, shape)), effect(source, shape)


def found_and_true(source, people, clips, effect, count, all_clips):
    """Differences of studies, NaN where an answer is missing, and the true one of each."""
    level, own = made_clips(source, effect, (count, 1, clips, 1))
    steps = plan.answers_to(source, people, level, own, 1).astype(float)
    true = all_clips[effect] if clips >= inference.MANY_CLIPS else plan.difference_for(level, own, 1)
    return steps[..., 1] - steps[..., 0], true


def simulated(source, studies, people, clips, all_clips):
    """Of the studies of a design, in the order of the columns."""
    parts = []
    for begin in range(0, studies, AT_ONCE):
        count, misses, found = min(AT_ONCE, studies - begin), [], None
        for effect in alike, differ, few_carry_it:
            d, true = found_and_true(source, people, clips, effect, count, all_clips)
            found = inference.difference(d)
            low, high = found.interval()
            misses.append((true < low) | (high < true))
            if effect is alike:
                shown = found.p_of_equivalence(0.5) < 0.05
        d[source.random(d.shape) < MISSING] = np.nan
        low, high = inference.difference(d).interval()
        parts.append([*misses, (true < low) | (high < true), found.p_of_equivalence(abs(true)) < 0.05, shown])
    return [f"{100 * np.concatenate(each).mean():.1f}" for each in zip(*parts)]


def looks(source, studies):
    """One at the end, four, and after each person from the second on, as the report has them."""
    people, clips = 24, 6
    print("\n| looks | each at 5 %: found without a difference % | with one % | by levels: without % | with % |\n" + "|---" * 5 + "|")
    p = {}
    for log_odds in 0, math.log(3):
        d = plan.answers_to(source, people, source.normal(0, 0.8, (studies, 1, clips, 1)), log_odds, 1).astype(float)
        d = d[..., 1] - d[..., 0]
        p[log_odds] = np.array([inference.difference(d[:, :n]).p() for n in range(2, people + 1)])
    for name, at in ("at the end", [people]), ("four", [6, 12, 18, people]), ("after each person", range(2, people + 1)):
        levels = np.array(inference.levels(at, people, 0.05))[:, None]
        cells = [100 * (p[effect][[n - 2 for n in at]] < most).any(axis=0).mean() for most in (0.05, levels) for effect in p]
        print(f"| {name} | " + " | ".join(f"{cell:.1f}" for cell in cells) + " |", flush=True)


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
    source = np.random.default_rng(1)
    all_clips = {effect: plan.difference_for(*made_clips(source, effect, (1, 1, MANY, 1)), 1)[0]
                 for effect in (alike, differ, few_carry_it)}
    print("| participants | clips | alike % | differ % | one in five % | 3 % missing % | equal % | shown % |\n" + "|---" * 8 + "|")
    for people, clips in DESIGNS:
        print(f"| {people} | {clips} | {' | '.join(simulated(source, studies, people, clips, all_clips))} |", flush=True)
    looks(np.random.default_rng(1), studies)
    thresholds(max(50, studies // 20))


if __name__ == "__main__":
    main()
