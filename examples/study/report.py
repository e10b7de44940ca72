# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Shares, means, sign tests and ordinal models of the answers of a study."""

import math
from collections import Counter, defaultdict

from scipy.stats import binomtest

from ordinal import Model
from records import Participants, read_rows, read_settings
from trials import CONDITIONS, PAIRS

FIRST_GOOD = 3  # the paper counts "average" as good


def sign_test(more, less):
    """p (two-sided) and 95 % interval (Clopper–Pearson) of the share of `more` in those that differ."""
    if more + less == 0:
        return 1.0, (0.0, 1.0)
    test = binomtest(more, more + less)
    return test.pvalue, tuple(test.proportion_ci(method="exact"))


def ratings(answers):
    """Steps by (part, question, condition), in the order in which questions appear, the first condition first."""
    steps = defaultdict(list)
    for answer in answers:
        steps[answer.part, answer.question, answer.condition].append(answer.answer)
    questions = dict.fromkeys((answer.part, answer.question) for answer in answers)
    return {(part, question, condition): steps[part, question, condition] for part, question in questions
            for condition in CONDITIONS[part] if (part, question, condition) in steps}


def pairs_of(answers):
    """By (part, question, first condition, second): lists of (participant, clip, first answer, second answer)."""
    given = defaultdict(dict)
    for answer in answers:
        given[answer.part, answer.question, answer.participant, answer.clip][answer.condition] = answer.answer
    questions = dict.fromkeys((answer.part, answer.question) for answer in answers)
    pairs = {(part, question, *pair): [] for part, question in questions for pair in PAIRS[part]}
    for (part, question, participant, clip), by_condition in given.items():
        for first, second in PAIRS[part]:
            if first in by_condition and second in by_condition:
                pairs[part, question, first, second].append(
                    (participant, clip, by_condition[first], by_condition[second]))
    return pairs


def comparisons(pairs):
    """Participants who are higher, lower and equal (1, −1, 0) in the second condition.

    The answers of one person are not independent: what counts is the difference of their means over the clips that were
    seen in both conditions.
    """
    differences = defaultdict(int)
    for participant, _, first, second in pairs:
        differences[participant] += second - first
    return Counter((difference > 0) - (difference < 0) for difference in differences.values())


def odds_ratio(pairs):
    """Of the ordinal model: how much the odds of a higher answer grow, in words, with its p."""
    participants, clips, first, second = zip(*pairs)
    model = Model([*first, *second], [False] * len(first) + [True] * len(second), participants * 2, clips * 2)
    fit = model.fit()
    low, high = (math.exp(min(value, 700)) for value in fit.interval())
    if not math.isfinite(fit.standard_error):
        return "not determined", fit.p
    return f"{math.exp(fit.log_odds):.2f} ({low:.2f} to {high:.2f})", fit.p


def describe_study(path):
    """What the answers were made with, and what became of participants and presentations."""
    lines, settings = [], read_settings(path)
    if settings:
        lines.append(", ".join(f"{name} {settings[name]}" for name in ("version", "device", "profile", "host", "seed")
                               if settings[name] != "") + (", the paper's setting" if settings["paper"] else ""))
    shown = read_rows(f"{path}.presentations")
    failed = Counter(row["problem"] for row in shown if row["problem"])
    if shown:
        lines.append(f"{len(shown)} presentations, {sum(failed.values())} of which do not count"
                     + "".join(f"; {count}: {problem}" for problem, count in failed.items()))
    withdrew = Participants(path).withdrew()
    if withdrew:
        lines.append(f"withdrew: {withdrew}")
    return lines + [""] * bool(lines)


def report(answers, path=None):
    lines = describe_study(path) if path else []
    lines += ["question                   condition   answers   bad  poor   avg  good very   good %  mean"]
    for (part, question, condition), steps in ratings(answers).items():
        counts = [steps.count(step) for step in range(1, 6)]
        good = 100 * sum(counts[FIRST_GOOD - 1:]) / len(steps)
        lines.append(f"{part + ': ' + question:26} {condition:11} {len(steps):7} " +
                     " ".join(f"{count:{5 if step < 4 else 4}}" for step, count in enumerate(counts)) +
                     f"   {good:6.0f}  {sum(steps) / len(steps):4.2f}")
    lines += ["", "good: average and better, as the paper counts. Below: participants whose mean is higher or lower with",
              "the second condition; exact sign test, two-sided; share of those that differ. Cumulative link mixed model:",
              "its p (likelihood ratio) and the odds ratio of a higher answer. Intervals are those of 95 %.", "",
              "question                   conditions             higher  lower  equal        p   "
              "share higher            p, model  odds ratio"]
    for (part, question, first, second), pairs in pairs_of(answers).items():
        if not pairs:
            continue
        count = comparisons(pairs)
        p, (low, high) = sign_test(count[1], count[-1])
        differ = count[1] + count[-1]
        share = f"{count[1] / differ:.2f} ({low:.2f} to {high:.2f})" if differ else "-"
        ratio, p_of_model = odds_ratio(pairs)
        lines.append(f"{part + ': ' + question:26} {first + ', ' + second:22} {count[1]:6} {count[-1]:6} {count[0]:6}  "
                     f"{p:7.3g}   {share:22}  {p_of_model:7.3g}   {ratio}")
    return "\n".join(lines)
