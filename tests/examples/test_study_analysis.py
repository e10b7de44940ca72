#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The study's statistics: tables, tests, and whether a known effect is found again.

    test_study_analysis.py FOLDER-OF-STUDY.PY
"""

import contextlib
import io
import math
import re
import sys
import unittest
from argparse import Namespace
from collections import Counter

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import numpy as np  # noqa: E402
from scipy.special import expit  # noqa: E402
from scipy.stats import binom  # noqa: E402

import ordinal  # noqa: E402
import plan  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402


def answer(participant, part, condition, question, step, clip="a.avi"):
    return records.Answer(f"P{participant}", 1, part, condition, "A2", clip, question, step, "")


class Report(unittest.TestCase):
    def test_the_sign_test_is_the_exact_two_sided_one(self):
        self.assertAlmostEqual(report.sign_test(8, 2)[0], 112 / 1024, 12)  # 2 (1 + 10 + 45) / 1024
        self.assertAlmostEqual(report.sign_test(10, 0)[0], 2 / 1024, 12)
        self.assertEqual(report.sign_test(0, 0), (1, (0, 1)))
        # Clopper and Pearson's interval of no success of 10: 1 − 0.025^(1/10).
        self.assertAlmostEqual(report.sign_test(0, 10)[1][1], 1 - 0.025**0.1, 9)

    def test_gives_the_tables_of_the_paper(self):
        # As in Table 1: linear good for five of ten, nonlinear for eight; and as "reality" of Table 2, 2.4 and 4.2.
        given = {("controllers", "nonlinear", "movement"): [2, 1, 3, 4, 5, 4, 4, 5, 3, 5],
                 ("controllers", "linear", "movement"): [1, 2, 2, 1, 2, 3, 4, 5, 3, 3],
                 ("haptics", "with", "reality"): [4, 4, 4, 4, 4, 4, 4, 4, 5, 5],
                 ("haptics", "sham", "reality"): [4, 4, 4, 4, 4, 4, 4, 4, 5, 4],
                 ("haptics", "without", "reality"): [2, 2, 2, 3, 3, 3, 2, 2, 2, 3]}
        answers = [answer(number, *key, step) for key, steps in given.items() for number, step in enumerate(steps)]
        rows = [re.split("  +", line) for line in report.report(answers).splitlines()]
        self.assertEqual(rows[1][:2], ["controllers: movement", "linear"], "the first condition first")
        shares = {row[1]: (row[-2], row[-1]) for row in rows[1:6]}
        self.assertEqual(shares, {"linear": ("50", "2.60"), "nonlinear": ("80", "3.60"), "without": ("40", "2.40"),
                                  "sham": ("100", "4.10"), "with": ("100", "4.20")})
        # Differences 1 −1 1 3 3 1 0 0 0 2: p is 2 (1 + 7) / 2⁷.
        self.assertEqual(rows[-3][:6], ["controllers: movement", "linear, nonlinear", "6", "1", "3", "0.125"])
        self.assertEqual(rows[-2][:6], ["haptics: reality", "without, with", "10", "0", "0", "0.00195"])
        self.assertEqual(rows[-1][:6], ["haptics: reality", "sham, with", "1", "0", "9", "1"])
        self.assertRegex(rows[-3][-1], r"^\d+\.\d+ \(\d+\.\d+ to \d+\.\d+\)$")

    def test_counts_a_person_once_and_only_what_is_complete(self):
        # Three clips, two better and one much worse: worse as a whole, and one vote. The other stopped within a pair.
        answers = [answer(1, "controllers", condition, "movement", step, clip) for condition, step, clip in
                   [("linear", 3, "a"), ("nonlinear", 4, "a"), ("linear", 3, "b"), ("nonlinear", 4, "b"),
                    ("linear", 5, "c"), ("nonlinear", 1, "c")]] + [answer(2, "controllers", "linear", "movement", 3)]
        pairs = report.pairs_of(answers)["controllers", "movement", "linear", "nonlinear"]
        self.assertEqual((len(pairs), report.comparisons(pairs)), (3, Counter({-1: 1})))

    def test_answers_without_any_difference_are_no_error(self):
        same = [answer(n, "controllers", condition, "movement", 3) for n in range(3)
                for condition in ("linear", "nonlinear")]
        self.assertIn("not determined", report.report(same))


class Ordinal(unittest.TestCase):
    LOG_ODDS = 1.0

    def fits(self, count, log_odds, participants=48, clips=3, spread=1.0):
        random = np.random.default_rng(5)
        return [plan.model_of(plan.made_answers(random, participants, clips, log_odds, spread)).fit()
                for _ in range(count)]

    def test_the_gradient_is_that_of_the_likelihood(self):
        model = plan.model_of(plan.made_answers(np.random.default_rng(1), 12, 2, 1.0, 1.0))
        at = model.start() + 0.1
        value, gradient = model.minus_log_likelihood(at)
        for n, row in enumerate(np.eye(len(at))):
            # Central differences: error of h² and of rounding / h, both below 1e-6 of the likelihood, some 100.
            h = 1e-5
            numeric = (model.minus_log_likelihood(at + h * row)[0] - model.minus_log_likelihood(at - h * row)[0]) / (2 * h)
            self.assertAlmostEqual(gradient[n], numeric, delta=1e-6 * value)

    def test_without_spread_it_is_the_likelihood_of_proportional_odds(self):
        """By the formula, for one threshold: answers of two steps, no clips, nearly no spread."""
        steps, second = np.array([1, 2, 2, 1, 2, 2]), np.array([0, 0, 0, 1, 1, 1], bool)
        model = ordinal.Model(steps, second, range(6), np.zeros(6))
        theta, beta = 0.3, 0.7
        at = np.array([theta, beta, -30, -30])
        below = expit(theta - beta * np.where(second, 0.5, -0.5))
        self.assertAlmostEqual(model.minus_log_likelihood(at)[0], -np.log(np.where(steps == 1, below, 1 - below)).sum(), 9)

    def test_a_known_effect_is_found_again(self):
        fits = self.fits(12, self.LOG_ODDS)
        estimates = np.array([fit.log_odds for fit in fits])
        # Four standard errors of the mean, and the bias of maximum likelihood, of the order of 1 / 48 participants
        # relative for each of its nine parameters.
        error = estimates.std(ddof=1) / math.sqrt(len(fits))
        self.assertLess(abs(estimates.mean() - self.LOG_ODDS), 4 * error + 9 / 48 * self.LOG_ODDS / 2)
        covered = sum(low < self.LOG_ODDS < high for low, high in (fit.interval() for fit in fits))
        self.assertGreaterEqual(covered, binom.ppf(1e-4, len(fits), 0.95))
        self.assertLess(abs(np.mean([fit.spread[0] for fit in fits]) - 1), 0.3)  # σ; of 48 people, each ± 15 %

    def test_no_effect_is_rarely_found(self):
        found = sum(fit.p < 0.05 for fit in self.fits(16, 0.0, participants=24))
        self.assertLessEqual(found, binom.ppf(1 - 1e-4, 16, 0.05))

    def test_an_effect_without_exceptions_has_no_interval(self):
        steps = np.tile([1, 5], (12, 1, 1))
        fit = plan.model_of(steps).fit()
        self.assertLess(fit.p, 1e-4)
        self.assertTrue(math.isinf(fit.standard_error) or fit.interval()[1] > 10)


class Plan(unittest.TestCase):
    def plan(self, **options):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            plan.plan(Namespace(**({"odds_ratio": 4.0, "clips": 2, "spread": 1.0, "power": 0.8, "level": 0.05,
                                    "simulations": 20} | options)))
        return out.getvalue()

    def test_made_answers_have_the_effect(self):
        steps = plan.made_answers(np.random.default_rng(1), 40000, 1, math.log(4), 0.0)
        good = (steps >= 4).mean(axis=(0, 1))
        odds = good / (1 - good)
        # Standard error of a log odds ratio of 2 · 40000 answers: below sqrt(2 / (40000 · 0.2)) = 0.016.
        self.assertAlmostEqual(math.log(odds[1] / odds[0]), math.log(4), delta=0.064)

    def test_power_of_the_sign_test_is_that_of_the_formula(self):
        """One clip and no spread: whether the second answer is higher is drawn from known shares."""
        log_odds, n, count = math.log(4), 24, 400
        cuts = np.r_[-np.inf, plan.THRESHOLDS, np.inf]
        first, second = (np.diff(expit(cuts - side * log_odds / 2)) for side in (-1, 1))
        joint = np.outer(first, second)
        higher, lower = np.triu(joint, 1).sum(), np.tril(joint, -1).sum()
        power = 0
        for differ in range(n + 1):
            found = [k for k in range(differ + 1) if 2 * k > differ and report.sign_test(k, differ - k)[0] < 0.05]
            power += binom.pmf(differ, n, higher + lower) * binom.pmf(found, differ, higher / (higher + lower)).sum()
        random = np.random.default_rng(2)
        simulated = sum(plan.sign_test_finds(plan.made_answers(random, n, 1, log_odds, 0.0), 0.05) for _ in range(count))
        self.assertLess(abs(simulated / count - power), 4 * math.sqrt(0.25 / count))

    def test_says_how_many_participants_are_needed(self):
        few, many = (int(re.search(r"(\d+) participants are enough", self.plan(odds_ratio=ratio))[1])
                     for ratio in (100, 4))
        self.assertEqual(few, 12)
        self.assertGreater(many, 12)
        with self.assertRaisesRegex(ValueError, "is no effect"):
            self.plan(odds_ratio=1)


if __name__ == "__main__":
    unittest.main()
