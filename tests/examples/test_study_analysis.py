#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The study's statistics: tables, tests, their errors, and whether a known effect is found again.

    test_study_analysis.py FOLDER-OF-STUDY.PY
"""

import contextlib
import io
import math
import re
import sys
import tempfile
import unittest
from argparse import Namespace
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import numpy as np  # noqa: E402
from scipy.stats import norm, ttest_1samp  # noqa: E402

import briefing  # noqa: E402
import chain  # noqa: E402
import inference  # noqa: E402
import plan  # noqa: E402
import records  # noqa: E402
import registration  # noqa: E402
import report  # noqa: E402
import study_files  # noqa: E402
import trials  # noqa: E402


def answer(participant, part, condition, question, step, clip="a.avi"):
    return records.Answer(f"P{participant}", 1, part, condition, "A2", clip, question, step, "")


class Inference(unittest.TestCase):
    def test_is_the_estimate_of_a_mixed_model(self):
        """d = μ + a_p + b_c + e by restricted likelihood, MixedLM of statsmodels 0.13: mean 1.25, error 0.74999."""
        d = np.array([[1, 2, 0], [2, 3, 1], [0, 2, -1], [1, 3, 1]])
        with patch.object(inference, "MANY_CLIPS", 3):
            found = inference.difference(d)
        self.assertAlmostEqual(found.mean, 1.25, 12)
        self.assertAlmostEqual(found.error, 0.75, 4)
        people, clips, rest = 59 / 36, 21 / 4, 5 / 36  # mean squares, by hand
        self.assertAlmostEqual(found.error**2, (people + clips - rest) / 12, 12)
        self.assertAlmostEqual(found.freedom, (people + clips - rest)**2 / (people**2 / 3 + clips**2 / 2 + rest**2 / 6), 9)

    def test_is_the_t_test_of_few_clips_and_where_clips_are_alike(self):
        random = np.random.default_rng(3)
        person, many = random.normal(1, 1, (12, 1)), inference.MANY_CLIPS
        for d in (person, person + random.normal(0, 1, (12, 4)) + [[0, 0, 0, 3]], person + np.zeros((12, many)),
                  person + np.tile([0.1, -0.1], (12, many // 2)) * random.choice([-1, 1], (12, 1))):
            found = inference.difference(d)
            self.assertAlmostEqual(found.p(), ttest_1samp(d.mean(axis=1), 0).pvalue, 9)
            self.assertAlmostEqual(found.freedom, 11, 9)

    def test_missing_answers_are_what_person_and_clip_would_give(self):
        """By least squares of the additive model, in which what is missing has no weight; in a stack, too."""
        random = np.random.default_rng(8)
        whole = random.normal(0, 1, (9, 1)) + random.normal(0, 1, (1, 5)) + random.normal(0, 1, (9, 5))
        d = whole.copy()
        d[[0, 3, 3, 7], [1, 0, 4, 2]] = np.nan
        known = np.argwhere(~np.isnan(d))
        design = np.array([[*np.eye(9)[person], *np.eye(5)[clip]] for person, clip in known])
        fitted = np.linalg.lstsq(design, d[tuple(known.T)], rcond=None)[0]
        filled, missing = inference.filled(np.stack([d, whole]))
        for person, clip in np.argwhere(np.isnan(d)):
            self.assertAlmostEqual(filled[0, person, clip], fitted[person] + fitted[9 + clip], 9)
        np.testing.assert_array_equal(filled[1], whole)
        self.assertEqual(list(missing), [4, 0])
        rest = [inference.difference(each) for each in (d, filled[0])]
        self.assertEqual((rest[0].mean, rest[0].error), (rest[1].mean, rest[1].error))

    def test_three_per_cent_of_missing_answers_cost_little(self):
        """24 people, 12 clips: an interval wider by √(1 / 0.97) of what people and clips differ in each answer, at most."""
        random, studies = np.random.default_rng(9), 500
        steps = plan.made_answers(random, 24, 12, math.log(3), 1, 0.8, (studies,)).astype(float)
        whole = steps[..., 1] - steps[..., 0]
        part = np.where(random.random(whole.shape) < 0.03, np.nan, whole)
        found = [(inference.difference(d).p() < 0.05).mean() for d in (whole, part)]
        self.assertGreater(found[0], 0.7)
        self.assertGreater(found[1], found[0] - 0.05)  # 0.79 and 0.78; who has rated all: 0.62

    def test_a_stack_of_studies_is_each_of_them(self):
        random = np.random.default_rng(5)
        for people, clips in (12, 1), (12, 3), (12, 13), (3, 15):
            stack = random.normal(0.5, 1, (20, people, clips)) + random.normal(0, 1, (20, 1, clips))
            together = inference.difference(stack)
            for n, d in enumerate(stack):
                alone = inference.difference(d)
                for value in "mean", "error", "freedom":
                    self.assertAlmostEqual(getattr(together, value)[n], getattr(alone, value), 12)
                self.assertAlmostEqual(together.p()[n], alone.p(), 12)

    def test_few_clips_speak_of_themselves(self):
        """Clips of which one in five carries an effect: of these, an interval of 95 % misses 5 %, of all clips far more."""
        random, studies = np.random.default_rng(7), 4000
        for people, clips in (24, 4), (120, 6):
            level, effect = random.normal(0, 0.8, (studies, 1, clips, 1)), 2.0 * (random.random((studies, 1, clips, 1)) < 0.2)
            steps = plan.answers_to(random, people, level, effect, 1)
            low, high = plan.difference_of(steps).interval()
            missed = lambda true: float(((true < low) | (high < true)).mean())
            # 4 standard deviations of 4000 studies at 5 %, and a per cent for steps that are not normally distributed.
            self.assertLess(abs(missed(plan.difference_for(level, effect, 1)) - 0.05), 4 * math.sqrt(0.05 * 0.95 / studies) + 0.01)
            self.assertGreater(missed(plan.difference_for(level, effect, 1).mean()), 0.1)

    def test_without_any_difference_there_is_nothing_to_say(self):
        for d in np.zeros((5, 3)), np.ones((5, 3)), np.ones((1, 3)):
            found = inference.difference(d)
            self.assertEqual((found.p(), found.p_of_equivalence(0.5), found.interval()), (1, 1, (-np.inf, np.inf)))

    def test_equivalence_is_two_one_sided_tests(self):
        """At a level of 5 % if and only if the 90 % interval lies within the margin."""
        random = np.random.default_rng(4)
        for _ in range(50):
            found = inference.difference(random.normal(random.normal(0, 0.3), 1, (24, 4)))
            low, high = found.interval(0.9)
            self.assertEqual(found.p_of_equivalence(0.5) < 0.05, -0.5 < low and high < 0.5)

    def test_looks_have_the_levels_of_ldbounds(self):
        """Bounds of the package of R for the function of O'Brien and Fleming, two-sided at 5 %; one look is the test."""
        for fractions, bounds in ([0.2, 0.4, 0.6, 0.8, 1], [4.8769, 3.3569, 2.6803, 2.2898, 2.0310]), ([0.5, 1], [2.9626, 1.9686]), ([1], [1.9600]):
            looks = [inference.FIRST_PEOPLE + 1000 * part for part in fractions]
            for found, bound in zip(inference.levels(looks, looks[-1], 0.05), bounds):
                self.assertAlmostEqual(norm.isf(found / 2), bound, delta=2e-4)
        for looks, planned, expected in ([3, 5, 24], 24, [0, 0]), ([1, 3], 3, [0, 0.05]), ([1, 3, 4], 4, [0, 0]):
            np.testing.assert_allclose(inference.levels(looks, planned, 0.05)[:2], expected, atol=1e-12, err_msg="so early, nothing is spent")

    def test_looks_err_no_more_often_together_than_one_test(self):
        """In studies without an effect, t over 24 people: looked at after each person from the second on, and the test only at the
        end. In 4000 studies at 5 %, four standard deviations are 1.4 %; the levels are of a normal distribution."""
        d = np.random.default_rng(11).normal(0, 1, (4000, 24, 1))
        looks = range(2, 25)
        p = np.array([inference.difference(d[:, :people]).p() for people in looks])
        together = (p < np.array(inference.levels(looks, 24, 0.05))[:, None]).any(axis=0).mean()
        self.assertLess(together, 0.05 + 0.014)
        self.assertGreater((p < 0.05).any(axis=0).mean(), 0.15, "and without them far more")

    def test_holm(self):
        self.assertEqual(inference.holm([]), [])
        for found, expected in zip(inference.holm([0.03, 0.01, 0.04, 0.9]), [0.09, 0.04, 0.09, 0.9]):
            self.assertAlmostEqual(found, expected, 12)
        self.assertEqual(inference.holm([0.6, 0.7]), [1, 1])

    def test_errors_are_as_rare_as_they_should_be(self):
        """Of 4000 studies of each kind."""
        for clip_spread in 0, 0.8:
            for log_odds in 0, math.log(8):
                random = np.random.default_rng(int(10 * clip_spread + log_odds))
                true = plan.true_difference(log_odds, 1, clip_spread)
                low, high = plan.difference_of(
                    plan.made_answers(random, 24, 12, log_odds, 1, clip_spread, (4000,))).interval()
                covered = ((low < true) & (true < high)).mean()
                self.assertGreaterEqual(covered, 0.93)
                self.assertLess(covered, 0.975, "and the interval is no wider than it need be")


class Report(unittest.TestCase):
    @staticmethod
    def rows(text):
        return [re.split("  +", line) for line in text.splitlines()]

    def test_gives_the_tables_of_the_paper(self):
        # As in Table 1: linear good for five of ten, nonlinear for eight; and as "reality" of Table 2, 2.4 and 4.2.
        given = {("controllers", "nonlinear", "movement"): [2, 1, 3, 4, 5, 4, 4, 5, 3, 5],
                 ("controllers", "linear", "movement"): [1, 2, 2, 1, 2, 3, 4, 5, 3, 3],
                 ("haptics", "with", "reality"): [4, 4, 4, 4, 4, 4, 4, 4, 5, 5],
                 ("haptics", "sham", "reality"): [4, 4, 4, 4, 4, 4, 4, 4, 5, 4],
                 ("haptics", "without", "reality"): [2, 2, 2, 3, 3, 3, 2, 2, 2, 3],
                 ("haptics", "with", "comfort"): [3, 4] * 5, ("haptics", "sham", "comfort"): [3, 4, 4, 3, 3, 4, 3, 4, 3, 4],
                 ("haptics", "without", "comfort"): [4, 3] * 5}
        answers = [answer(number, *key, step) for key, steps in given.items() for number, step in enumerate(steps)]
        rows = self.rows(report.report(answers))
        self.assertEqual(rows[1][:2], ["controllers: movement", "linear"], "the first condition first")
        shares = {row[1]: (row[-2], row[-1]) for row in rows[1:6]}
        self.assertEqual(shares, {"linear": ("50", "2.60"), "nonlinear": ("80", "3.60"), "without": ("40", "2.40"),
                                  "sham": ("100", "4.10"), "with": ("100", "4.20")})
        found = {(row[0], row[1]): row[2:] for row in rows if len(row) == 7 and ":" in row[0]}
        self.assertEqual(len(found), 5)
        d = np.subtract(given["controllers", "nonlinear", "movement"], given["controllers", "linear", "movement"])
        people, clips, interval, p, holm = found["controllers: movement", "linear, nonlinear"]
        self.assertEqual((people, clips), ("10", "1"))
        self.assertRegex(interval, r"^\+1.00 \(-?\d.\d\d to \d.\d\d\)$")
        self.assertAlmostEqual(float(p), ttest_1samp(d, 0).pvalue, 3)
        self.assertEqual(p, holm, "the only one of its family")
        p, holm = map(float, found["haptics: reality", "without, with"][3:])
        self.assertLess(abs(holm / p - 2), 0.02, "the smaller one of two")
        self.assertGreater(float(found["haptics: comfort", "without, with"][3]), 0.05, "ten people differ too much")
        self.assertLess(float(found["haptics: comfort", "sham, with"][3]), 0.05, "equal")

    def test_uses_who_has_rated_half_of_the_clips(self):
        steps = lambda who, *pairs: [answer(who, "controllers", condition, "movement", step, clip) for clip, *both in pairs
                                     for condition, step in zip(("linear", "nonlinear"), both)]
        answers = steps(1, ("a", 3, 4), ("b", 3, 4), ("c", 5, 1)) + steps(2, ("a", 1, 2), ("c", 2, 2), ("b", 2, 5))
        answers += steps(3, ("a", 1, 5), ("b", 1, 4), ("c", 1)) + steps(4, ("b", 1, 5), ("a", 1))
        (key, found), = report.differences(answers).items()
        self.assertEqual(key, ("controllers", "movement", "linear", "nonlinear"))
        np.testing.assert_array_equal(found, [[1, 1, -4], [1, 3, 0], [4, 3, np.nan]])

    def test_answers_without_any_difference_are_no_error(self):
        same = [answer(n, "controllers", condition, "movement", 3) for n in range(3)
                for condition in ("linear", "nonlinear")]
        self.assertIn("not determined", report.report(same))

    def test_says_of_which_clips_it_speaks(self):
        for clips, said in ("a", "these clips; of others, fewer than 12"), ("abcdefghijkl", "clips like these"):
            text = report.report([answer(n, "controllers", condition, "movement", n, clip) for n in (1, 2) for clip in clips
                                  for condition in ("linear", "nonlinear")])
            self.assertIn("other people and " + said, text)

    def test_does_what_was_decided_before(self):
        """And says what it would be without those who saw through."""
        random = np.random.default_rng(6)
        analysis = {"primary": "mine", "equal": ["reality"], "margin_steps": 2, "level": 0.01}
        # Frames of 0.3 N and 0.4 N, of 0.5 N and 0.56 N, and of less than is felt.
        frames = {"linear": [[0, 0.3, 0, 0], [40, 0, 0.5, 0], [80, 0.05, 0, 0]],
                  "nonlinear": [[0, 0.4, 0, 0], [40, 0, 0.56, 0], [80, 0, 0, 0]]}
        step = lambda trial, question: trial.part == "haptics" and question != "interactivity" and int(random.integers(1, 6))
        with tempfile.TemporaryDirectory() as folder:
            path = study_files.write(Path(folder, "answers.csv"), {f"P{n}": step for n in range(6)}, ["a.avi"], ["mine"],
                                     {"a.avi": {"frames": frames}}, analysis=analysis)
            with contextlib.redirect_stdout(io.StringIO()), chain.session(path):
                for n, belief in ((1, 2), (2, 0), (3, 4), (4, 2)):
                    records.append_row(path, ".briefings", [], [f"P{n}", "believed", briefing.BELIEFS[belief]])
                for row in ["P1", 0.06, 0.1, 20, ""], ["P2", 0.1, 0.2, "", 60], ["P3", "", "", "", ""], ["P4", 0.2, 0.3, 10, ""]:
                    records.append_row(path, ".thresholds", records.THRESHOLD_COLUMNS, [*row, 8, chain.utc_now()])
            with contextlib.redirect_stdout(io.StringIO()):
                text = report.report(records.read_answers(path), [path])
        self.assertNotIn("EXPLORATORY", text)
        self.assertIn("blinding index +0.42 of 4 people", text)  # two right, one of three wrong ones, one does not know
        self.assertIn("medians: force 0.100 N (3 people), change of it 20% (3 people), turn 15° (2 people), delay 60 ms (1 people)", text)
        self.assertRegex(text, r"(?m)^ +50 % of the felt frames of a.avi$")
        families = dict(re.findall(r"(?m)^(\w+) \(level 0.01\)\n.*\n(haptics: \w+)", text))
        self.assertEqual(families, {"primary": "haptics: mine", "secondary": "haptics: comfort", "equal": "haptics: reality"})
        self.assertIn("of 2 steps or more", text.replace("\n", " "))
        last = text[text.index("what has the sham, without the 2 who saw through"):]
        self.assertRegex(last, r"(?m)^haptics: mine +sham, with +4 ")
        self.assertNotIn("without, with", last)

    def test_a_registration_names_what_is_decided(self):
        settings = {"seed": 4, "version": "0.1", "device": "sim", "profile": "", "properties": ["max-force=1"],
                    "alpha_s_px": 0.01, "practice": "", "clips_sha256": {"a.avi": "1f", "b.avi": "2e"}, "analysis": trials.ANALYSIS,
                    "questions": trials.QUESTIONS | {"every clip": {"mine": "And this?"}}, "participants": 24}
        text = registration.text(settings, "2026-01-01T00:00:00Z", "12345678")
        for part in ("at 2026-01-01T00:00:00Z, whose code was then 12345678", "24 participants, 2 clips", "Primary: movement (linear against nonlinear)",
                     "Secondary: reality, interactivity, mine", "Equal within 0.5 steps", "mine: And this?",
                     "b.avi: SHA-256 2e", "alpha=0.01", records.digest_of(settings)):
            self.assertIn(part, text)


class Plan(unittest.TestCase):
    def plan(self, **options):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            plan.plan(Namespace(**({"odds_ratio": 8.0, "clips": [6], "spread": 1.0, "clip_spread": 0.8, "power": 0.8,
                                    "level": 0.05, "simulations": 1000, "primary": "movement"} | options)))
        return out.getvalue()

    @staticmethod
    def rows(text):
        """Clips, participants, and the interval of the power."""
        return [(int(clips), int(people), float(low), float(high)) for clips, people, low, high in
                re.findall(r"(?m)^ +(\d+) +(\d+) +\d\.\d\d \((\d\.\d\d) to (\d\.\d\d)\)", text)]

    @staticmethod
    def powers(text):
        """Of the primary outcome, by participants."""
        return {int(people): float(power) for people, power in re.findall(r"(?m)^ +\d+ +(\d+) +(\d\.\d\d) ", text)}

    def test_made_answers_have_the_effect(self):
        count = 40000
        for participants, clips, spread, clip_spread in (count, 1, 0, 0), (count, 1, 1, 0), (1, count, 0, 0.8):
            steps = plan.made_answers(np.random.default_rng(1), participants, clips, math.log(4), spread, clip_spread)
            shares = [[(steps[..., side] > step).mean() for step in range(1, 5)] for side in (0, 1)]
            for found, true in zip(np.ravel(shares), np.ravel(plan.shares_of(math.log(4), spread, clip_spread))):
                self.assertAlmostEqual(found, true, delta=4 * math.sqrt(0.25 / count))
            difference = (steps[..., 1] - steps[..., 0]).mean()
            # A difference of two steps, each of 1 to 5, has a variance of less than 2 · 4.
            self.assertAlmostEqual(difference, plan.true_difference(math.log(4), spread, clip_spread),
                                   delta=4 * math.sqrt(8 / count))

    def test_prints_the_odds_for_one_person_and_for_all(self):
        self.assertIn("over all people and clips 4: 43 % and 75 %", plan.effect_in_words(math.log(4), 0, 0))
        self.assertRegex(plan.effect_in_words(math.log(4), 1, 0.8), r"odds ratio 4 of .*and clips 2\.\d: ")

    def test_many_clips_are_as_a_sample_and_few_are_not(self):
        text = self.plan(clips=[4, 12])
        self.assertIn("with 4 clips, what is found is of these clips; from 12 on, of others like them", text)
        self.assertNotIn("with 12 clips, what is found", text)
        self.assertIn("12 participants are enough with 12 clips", text)
        few, many = (int(re.search(r"(\d+) participants are enough", self.plan(odds_ratio=ratio, clips=[12]))[1])
                     for ratio in (8, 2.5))
        self.assertGreater(many, few)
        # How others differ is known from clips alone: where these differ much, people do not help.
        text = self.plan(odds_ratio=2, clips=[12], clip_spread=2)
        self.assertIn("with 12 clips the power stays below 0.8 up to 120 participants: take more clips", text)

    def test_says_enough_only_where_it_is_known(self):
        """And a power just at the aim is not above."""
        text = self.plan(odds_ratio=3, clips=[12], simulations=500)
        for clips, people, low, high in self.rows(text):
            self.assertEqual(f"{people} participants are enough with {clips}" in text, low > 0.8)
        primary = self.powers(self.plan(odds_ratio=7, clips=[12], simulations=1))[12]
        close = self.plan(odds_ratio=7, clips=[12], power=primary, simulations=1)
        self.assertNotIn("12 participants are enough", close)

    def test_corrects_for_the_family_as_the_report_does(self):
        """Which has one comparison of movement, two of another question, and three of one of the study's own."""
        alone, family, own = (self.powers(self.plan(clips=[12], odds_ratio=3, primary=primary, simulations=2000))[24]
                              for primary in ("movement", "comfort", "mine"))
        self.assertAlmostEqual(alone, 0.86, delta=0.04)  # two standard deviations of 500 studies and more
        self.assertAlmostEqual(family, 0.755, delta=0.05)
        self.assertAlmostEqual(own, 0.695, delta=0.05)
        for primary, numbers in ("movement", (1, 4, 2)), ("comfort", (2, 5, 0)), ("mine", (3, 5, 2)):
            found = trials.families(trials.analysis_of(primary))
            self.assertEqual(tuple(len(found[family]) for family in trials.FAMILIES), numbers)

    def test_tells_that_few_people_cannot_show_equality(self):
        few = re.search(r"(?m)^ +6 +12 .* (0\.\d\d) +\d+$", self.plan(clips=[6]))
        self.assertLess(float(few[1]), 0.05)

    def test_the_page_has_what_its_command_prints(self):
        page = (Path(FOLDER).resolve().parents[1] / "docs/study.md").read_text()
        command = re.search(r"study.py plan --odds-ratio (\S+) --clips ([\d ]+)\n", page)
        text = self.plan(odds_ratio=float(command[1]), clips=list(map(int, command[2].split())), simulations=16000)
        for found, printed in zip(self.rows(page), self.rows(text)):
            self.assertEqual(found[:2], printed[:2])
            for one, other in zip(found[2:], printed[2:]):  # another NumPy may draw others
                self.assertAlmostEqual(one, other, delta=0.1)
        self.assertEqual(len(self.rows(page)), len(self.rows(text)))
        for verdict in re.findall(r"(?m)^\d+ participants are enough.*$", text):
            self.assertIn(verdict, page)

    def test_says_what_cannot_be_planned(self):
        nan, inf = math.nan, math.inf
        for options in ({"odds_ratio": 1}, {"odds_ratio": inf}, {"odds_ratio": nan}, {"clips": [0]}, {"power": 1}, {"power": nan},
                        {"clip_spread": -1}, {"spread": nan}, {"spread": inf}, {"level": 2}, {"level": 0}, {"simulations": 0}):
            (name, _), = options.items()
            with self.assertRaisesRegex(ValueError, f"--{name.replace('_', '-')}"):
                self.plan(**options)


if __name__ == "__main__":
    unittest.main()
