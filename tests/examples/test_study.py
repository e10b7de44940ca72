#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The study with participants: order of trials, briefing, file of answers, statistics, and a whole run.

    test_study.py FOLDER-OF-STUDY.PY
"""

import contextlib
import csv
import io
import re
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import briefing  # noqa: E402
import report  # noqa: E402
import trials  # noqa: E402
from check_player import make_clip  # noqa: E402

CLIPS = ["a.avi", "b.avi", "c.avi"]


def typed(lines):
    """Lines on standard input, then its end."""
    return patch("builtins.input", side_effect=[*lines, EOFError])


class Schedule(unittest.TestCase):
    def test_every_participant_sees_every_clip_in_every_condition(self):
        for index in range(20):
            shown = trials.schedule(CLIPS, index, 7)
            self.assertEqual([trial.number for trial in shown], list(range(1, 13)))
            self.assertEqual([trial.part for trial in shown], ["controllers"] * 6 + ["haptics"] * 6)
            self.assertEqual(len({(trial.clip, trial.condition) for trial in shown}), 12)
            self.assertEqual(len({trial.code for trial in shown}), 12, "no code twice")
            for first, second in zip(shown[::2], shown[1::2]):
                self.assertEqual(first.clip, second.clip, "both conditions of a clip in a row")
                self.assertRegex(first.code, "^[A-Z][0-9]$")

    def test_is_balanced_over_two_participants(self):
        for index in range(0, 10, 2):
            first = Counter((trial.clip, trial.condition) for participant in (index, index + 1)
                            for trial in trials.schedule(CLIPS, participant, 3)[::2])
            self.assertEqual(set(first.values()), {1})
            self.assertEqual(len(first), 12)

    def test_is_random_but_the_same_each_time(self):
        orders = {tuple(trial.clip for trial in trials.schedule(CLIPS, index, 1)) for index in range(30)}
        self.assertGreater(len(orders), 10)  # of 36 orders, 30 draws give 20 ± 2 different ones
        self.assertEqual(trials.schedule(CLIPS, 4, 1), trials.schedule(CLIPS, 4, 1))
        self.assertNotEqual(trials.schedule(CLIPS, 4, 1), trials.schedule(CLIPS, 4, 2))
        # Python promises that its generator gives this everywhere.
        self.assertEqual([trial.code for trial in trials.schedule(["x"], 0, 1)], ["M5", "C5", "M3", "F3"])
        with self.assertRaisesRegex(ValueError, "twice"):
            trials.schedule(["x", "x"], 0, 1)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "answers.csv")


class File(InFolder):
    def append(self, participant, trial, question, step):
        trials.append_row(self.path, trials.COLUMNS, [participant, trial.number, trial.part, trial.condition,
                                                      trial.code, trial.clip, question, step, "2020-01-01T00:00:00Z"])

    def test_is_resumed_where_it_ended(self):
        self.assertEqual(trials.read_answers(self.path), [])
        shown = trials.schedule(CLIPS, 0, 1)
        self.append("P1, Ada", shown[0], "movement", 4)
        self.append("P1, Ada", shown[1], "movement", 2)
        answers = trials.read_answers(self.path)
        self.assertEqual([answer.answer for answer in answers], [4, 2])
        still_open = trials.open_questions(answers, "P1, Ada", shown, {"mine": "And this?"})
        self.assertEqual([list(questions) for questions in still_open[:3]], [["mine"], ["mine"], ["movement", "mine"]])
        self.assertEqual(list(still_open[-1]), ["reality", "interactivity", "comfort", "mine"])
        self.assertEqual([trials.index_of(answers, name) for name in ("P1, Ada", "P2")], [0, 1])
        other = trials.schedule(["z.avi"], 0, 1)
        with self.assertRaisesRegex(ValueError, "other clips or another seed: trial 1 was"):
            trials.open_questions(answers, "P1, Ada", other, {})
        trials.open_questions(answers, "P2", other, {})

    def test_says_what_is_wrong_and_where(self):
        header = ",".join(trials.COLUMNS) + "\n"
        good = "P1,1,controllers,linear,A2,a.avi,movement,3,now\n"
        for content, message in [
                ("hello\n", "answers.csv:1: not a file of answers"),
                (header + good + "P1,2\n", "answers.csv:3: 2 columns"),
                (header + good.replace(",3,", ",6,"), '"6" is no number from 1 to 5'),
                (header + good.replace("linear", "with"), '"controllers, with" is no part'),
                (header + good.replace(",1,", ",one,"), '"one" is no number of a trial')]:
            self.path.write_text(content)
            with self.assertRaisesRegex(ValueError, re.escape(message)):
                trials.read_answers(self.path)
        self.path.write_text(header + good)
        self.assertEqual(len(trials.read_answers(self.path)), 1)


class Terminal(unittest.TestCase):
    def test_asks_until_there_is_an_answer(self):
        out = io.StringIO()
        with typed(["", "6", "very good", "4", "q"]), contextlib.redirect_stdout(out):
            self.assertEqual(briefing.ask("How real?"), 4)
            for _ in "q", "the end of input":
                with self.assertRaises(briefing.Stopped):
                    briefing.ask("How real?")
        self.assertIn("How real?\n  1 bad  2 poor  3 average  4 good  5 very good", out.getvalue())


class Briefing(InFolder):
    RIGHT = ["yes", *["no"] * len(briefing.EXCLUSIONS), "yes"]  # consent, no reason against it, nothing loose
    STOP = ["yes", "yes"]

    def brief(self, lines, force_N=1, pulls=True):
        """Why the participant takes no part; empty if they do."""
        self.tight = False

        @contextlib.contextmanager
        def while_taut():
            self.tight = True
            yield
            self.tight = False

        with typed(lines):
            try:
                briefing.brief(self.path, "P1", force_N, while_taut if pulls else None)
            except (briefing.TakesNoPart, briefing.Stopped) as reason:
                return str(reason) or "stopped"
        return ""

    def record(self):
        return self.path.read_text() if self.path.exists() else ""

    def test_nobody_takes_part_without_consent_or_with_a_reason_against_it(self):
        right = self.RIGHT + self.STOP
        self.assertEqual(self.brief(right), "")
        for answer in "P1,consent,yes,20", "P1,eligible,yes,20", "P1,loose-things,yes,20", "P1,emergency-stop,yes,20":
            self.assertIn(answer, self.record())
        for number, answer in enumerate(right):
            wrong = right.copy()
            wrong[number] = "no" if answer == "yes" else "yes"
            self.assertIn("P1 does not take part", self.brief(wrong), number)
            self.assertEqual(self.brief(wrong[:number]), "stopped", number)
        # The reason itself is not recorded.
        self.assertIn("P1,eligible,no,20", self.record())
        self.assertNotIn("implant", self.record())

    def test_the_emergency_stop_is_tested_while_the_strings_are_taut(self):
        was_taut = []
        with patch.object(briefing, "is_yes", side_effect=lambda text: was_taut.append((text, self.tight)) or
                          not any(text == reason for reason in briefing.EXCLUSIONS)):
            self.assertEqual(self.brief([]), "")
        self.assertEqual([text[:44] for text, taut in was_taut if taut], ["The strings are taut, and nobody holds the g"])
        self.assertIn("Can the participant reach the stop", was_taut[-1][0])
        self.assertEqual(self.brief(self.RIGHT, pulls=False), "", "a simulated device has none")
        self.assertEqual(self.brief([*self.RIGHT, "maybe", *self.STOP]), "")

    def test_more_than_a_newton_must_be_confirmed_in_writing(self):
        for said in ["yes", "I am responsible for 2 N Ada", "I am responsible for 3 N", "I am responsible for 3 N "]:
            self.assertIn("not confirmed", self.brief([*self.RIGHT, said], 3, False), said)
        self.assertIn("not confirmed", self.brief([*self.RIGHT, "I am responsible for 3 N Ada"], float("nan"), False))
        self.assertEqual(self.brief([*self.RIGHT, "I am responsible for 3 N Ada"], 3, False), "")
        self.assertIn("P1,force,I am responsible for 3 N Ada,20", self.record())


def answer(participant, condition, question, step, clip="a.avi"):
    part = next(part for part, conditions in trials.CONDITIONS.items() if condition in conditions)
    return trials.Answer(f"P{participant}", 1, part, condition, "A2", clip, question, step, "")


class Report(unittest.TestCase):
    def test_the_sign_test_is_the_exact_two_sided_one(self):
        self.assertAlmostEqual(report.sign_test(8, 2)[0], 112 / 1024, 12)  # 2 (1 + 10 + 45) / 1024
        self.assertAlmostEqual(report.sign_test(10, 0)[0], 2 / 1024, 12)
        self.assertEqual(report.sign_test(0, 0), (1, (0, 1)))
        # Clopper and Pearson's interval of no success of 10: 1 − 0.025^(1/10).
        self.assertAlmostEqual(report.sign_test(0, 10)[1][1], 1 - 0.025**0.1, 9)

    def test_gives_the_tables_of_the_paper(self):
        # As in Table 1: linear good for five of ten, nonlinear for eight; and as "reality" of Table 2, 2.4 and 4.2.
        answers = []
        for number, steps in enumerate(zip([2, 1, 3, 4, 5, 4, 4, 5, 3, 5], [1, 2, 2, 1, 2, 3, 4, 5, 3, 3],
                                           [4, 4, 4, 4, 4, 4, 4, 4, 5, 5], [2, 2, 2, 3, 3, 3, 2, 2, 2, 3])):
            for condition, question, step in zip(("nonlinear", "linear", "with", "without"),
                                                 ("movement", "movement", "reality", "reality"), steps):
                answers.append(answer(number, condition, question, step))
        rows = [re.split("  +", line) for line in report.report(answers).splitlines()]
        self.assertEqual(rows[1][:2], ["controllers: movement", "linear"], "the first condition first")
        shares = {row[1]: (row[-2], row[-1]) for row in rows[1:5]}
        self.assertEqual(shares, {"linear": ("50", "2.60"), "nonlinear": ("80", "3.60"), "without": ("40", "2.40"),
                                  "with": ("100", "4.20")})
        # Differences 1 −1 1 3 3 1 0 0 0 2: p is 2 (1 + 7) / 2⁷.
        self.assertEqual(rows[-2][:5], ["controllers: movement", "6", "1", "3", "0.125"])
        self.assertEqual(rows[-1][:5], ["haptics: reality", "10", "0", "0", "0.00195"])

    def test_counts_a_person_once_and_only_what_is_complete(self):
        # Three clips, two better and one much worse: worse as a whole, and one vote. The other stopped within a pair.
        answers = [answer(1, condition, "movement", step, clip) for condition, step, clip in
                   [("linear", 3, "a"), ("nonlinear", 4, "a"), ("linear", 3, "b"), ("nonlinear", 4, "b"),
                    ("linear", 5, "c"), ("nonlinear", 1, "c")]] + [answer(2, "linear", "movement", 3, "a")]
        self.assertEqual(report.comparisons(answers), {("controllers", "movement"): Counter({-1: 1})})


class Run(unittest.TestCase):
    def test_plays_asks_and_keeps_what_was_felt(self):
        with tempfile.TemporaryDirectory() as folder:
            answers = Path(folder, "answers.csv")
            clip = make_clip(folder, 20)

            def run(lines, *more):
                return subprocess.run([sys.executable, FOLDER + "/study.py", "run", "--headless", answers, "P01", clip,
                                       *more], input="\n".join(lines) + "\n", text=True, capture_output=True)

            first = run([*Briefing.RIGHT, "", "4", "q"])
            self.assertEqual(first.returncode, 0, first)
            self.assertIn("stopped; the same command goes on here", first.stdout)
            done = run([*Briefing.RIGHT, "", "2", "", "3", "3", "3", "", "5", "5", "5"])
            self.assertEqual(done.returncode, 0, done)
            self.assertIn("that was all", done.stdout)
            for condition in "linear", "without", "with haptics":
                self.assertNotIn(condition, first.stdout + done.stdout, "only the code is shown")
            kept = trials.read_answers(answers)
            self.assertEqual([row.answer for row in kept], [4, 2, 3, 3, 3, 5, 5, 5])
            self.assertEqual({row.condition for row in kept}, {"linear", "nonlinear", "without", "with"})
            for row in kept:
                self.check_trace(f"{answers}.traces/P01-{row.trial}.haptic.csv", row.condition != "without")
            summary = subprocess.run([sys.executable, FOLDER + "/study.py", "report", answers], text=True,
                                     capture_output=True, check=True)
            self.assertIn("haptics: reality           with              1", summary.stdout)
            mistake = run([], "--", "max-force=much")
            self.assertEqual((mistake.returncode, "max-force" in mistake.stderr), (2, True), mistake)

    def check_trace(self, path, is_felt):
        with open(path, newline="") as file:
            forces = [abs(float(row["commanded_force_x_N"])) for row in csv.DictReader(file)]
        self.assertGreater(len(forces), 500)  # ticks in 0.8 s, even where some are lost
        self.assertEqual(max(forces) > 0, is_felt, path)
        self.assertLessEqual(max(forces), briefing.GENTLE_N)


if __name__ == "__main__":
    unittest.main()
