# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Shares, means and sign tests of the answers of a study."""

from collections import Counter, defaultdict

from scipy.stats import binomtest

from trials import CONDITIONS

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


def comparisons(answers):
    """Participants by (part, question) who are higher, lower and equal (1, −1, 0) in the second condition.

    The answers of one person are not independent: what counts is the difference of their means over the clips that were
    seen in both conditions.
    """
    pairs = defaultdict(dict)
    for answer in answers:
        pairs[answer.part, answer.question, answer.participant, answer.clip][answer.condition] = answer.answer
    differences = defaultdict(int)
    for (part, question, participant, _), by_condition in pairs.items():
        first, second = CONDITIONS[part]
        if len(by_condition) == 2:
            differences[part, question, participant] += by_condition[second] - by_condition[first]
    counts = {(answer.part, answer.question): Counter() for answer in answers}
    for (part, question, _), difference in differences.items():
        counts[part, question][(difference > 0) - (difference < 0)] += 1
    return counts


def report(answers):
    lines = ["question                   condition   answers   bad  poor   avg  good very   good %  mean"]
    for (part, question, condition), steps in ratings(answers).items():
        counts = [steps.count(step) for step in range(1, 6)]
        good = 100 * sum(counts[FIRST_GOOD - 1:]) / len(steps)
        lines.append(f"{part + ': ' + question:26} {condition:11} {len(steps):7} " +
                     " ".join(f"{count:{5 if step < 4 else 4}}" for step, count in enumerate(counts)) +
                     f"   {good:6.0f}  {sum(steps) / len(steps):4.2f}")
    lines += ["", "good: average and better, as the paper counts. Below: participants whose mean is higher or lower",
              "with nonlinear (with haptics); exact sign test, two-sided; share of those that differ with 95 %.", "",
              "question                    higher  lower  equal        p   share higher"]
    for (part, question), count in comparisons(answers).items():
        p, (low, high) = sign_test(count[1], count[-1])
        differ = count[1] + count[-1]
        share = f"{count[1] / differ:.2f} ({low:.2f} to {high:.2f})" if differ else "-"
        lines.append(f"{part + ': ' + question:26} {count[1]:7} {count[-1]:6} {count[0]:6}  {p:7.3g}   {share}")
    return "\n".join(lines)
