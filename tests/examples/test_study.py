#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The study with participants: order of trials, files, and what is asked.

    test_study.py FOLDER-OF-STUDY.PY
"""

import contextlib
import io
import math
import os
import pty
import random
import re
import statistics
import sys
import tempfile
import time
import unittest
from argparse import Namespace
from collections import Counter
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import briefing  # noqa: E402
import chain  # noqa: E402
import clip_player  # noqa: E402
import moving_square  # noqa: E402
import perception  # noqa: E402
import preview  # noqa: E402
import records  # noqa: E402
import study  # noqa: E402
import trials  # noqa: E402

CLIPS = ["a.avi", "b.avi", "c.avi"]


def typed(lines):
    """Lines on standard input, then its end."""
    return patch("builtins.input", side_effect=[*lines, EOFError])


def order_of(shown, part, clip):
    return tuple(trial.condition for trial in shown if (trial.part, trial.clip) == (part, clip))


class Schedule(unittest.TestCase):
    def test_every_participant_sees_every_clip_in_every_condition(self):
        for index in range(20):
            shown = trials.schedule(CLIPS, index, 7)
            self.assertEqual([trial.number for trial in shown], list(range(1, 16)))
            self.assertEqual(Counter(trial.part for trial in shown), {"controllers": 6, "haptics": 9})
            self.assertEqual(len({(trial.clip, trial.condition) for trial in shown}), 15)
            self.assertEqual(len({trial.code for trial in shown}), 15, "no code twice")
            runs = [trial.clip for n, trial in enumerate(shown) if n == 0 or shown[n - 1].clip != trial.clip
                    or shown[n - 1].part != trial.part]
            self.assertEqual(len(runs), 6, "the conditions of a clip follow each other")
            for trial in shown:
                self.assertRegex(trial.code, "^[A-Z][0-9]$")

    def test_no_code_comes_twice_however_many_clips_there_are(self):
        for clips in 26, 27, 200:
            codes = [trial.code for trial in trials.schedule([str(n) for n in range(clips)], 0, 1)]
            self.assertEqual(len(set(codes)), 5 * clips)

    def test_orders_are_balanced_over_twelve_participants(self):
        for first in 0, 12, 24:
            block = [trials.schedule(CLIPS, index, 3) for index in range(first, first + trials.BLOCK)]
            self.assertEqual(Counter(shown[0].part for shown in block), {"controllers": 6, "haptics": 6})
            for part, orders in trials.ORDERS.items():
                for clip in CLIPS:
                    # Also among those who began with the same part.
                    counts = Counter((shown[0].part, order_of(shown, part, clip)) for shown in block)
                    self.assertEqual((len(counts), set(counts.values())), (2 * len(orders), {6 // len(orders)}))

    def test_the_second_part_is_drawn_anew(self):
        """Whether the weaker condition of a clip comes first in both parts: by chance, in half of the cases."""
        same = [(order_of(shown, "controllers", clip)[0] == "linear") ==
                (order_of(shown, "haptics", clip).index("without") < order_of(shown, "haptics", clip).index("with"))
                for index in range(1200) for shown in [trials.schedule(CLIPS, index, 1)] for clip in CLIPS]
        # 1200 participants are independent of each other at least: 4 standard deviations of their mean.
        self.assertLess(abs(sum(same) / len(same) - 0.5), 4 * math.sqrt(0.25 / 1200))

    def test_is_random_but_the_same_each_time(self):
        orders = {tuple(trial.clip for trial in trials.schedule(CLIPS, index, 1)) for index in range(30)}
        self.assertGreater(len(orders), 10)  # of 36 orders of clips, 30 draws give 20 ± 2 different ones
        self.assertEqual(trials.schedule(CLIPS, 4, 1), trials.schedule(CLIPS, 4, 1))
        self.assertNotEqual(trials.schedule(CLIPS, 4, 1), trials.schedule(CLIPS, 4, 2))
        # Python promises that its generator gives this everywhere.
        self.assertEqual([trial.code for trial in trials.schedule(["x"], 0, 1)], ["M5", "C5", "M3", "F3", "H3"])
        with self.assertRaisesRegex(ValueError, "twice"):
            trials.schedule(["x", "x"], 0, 1)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "answers.csv")


class File(InFolder):
    def append(self, participant, trial, question, step):
        records.append_row(self.path, "", records.COLUMNS, [participant, trial.number, trial.part, trial.condition,
                                                        trial.code, trial.clip, question, step, "2020-01-01T00:00:00Z"])

    def test_is_resumed_where_it_ended(self):
        self.assertEqual(records.read_answers(self.path), [])
        shown = trials.schedule(CLIPS, 0, 1)
        self.append("P1, Ada", shown[0], "movement", 4)
        self.append("P1, Ada", shown[1], "movement", 2)
        answers = records.read_answers(self.path)
        self.assertEqual([answer.answer for answer in answers], [4, 2])
        still_open = trials.open_questions(answers, "P1, Ada", shown, {"mine": "And this?"})
        self.assertEqual([list(questions) for questions in still_open[:3]], [["mine"], ["mine"], ["movement", "mine"]])
        self.assertEqual(list(still_open[-1]), ["reality", "interactivity", "comfort", "mine"])
        other = trials.schedule(["z.avi"], 0, 1)
        with self.assertRaisesRegex(ValueError, "other trials: 1 was"):
            trials.open_questions(answers, "P1, Ada", other, {})
        trials.open_questions(answers, "P2", other, {})

    def test_who_withdraws_leaves_nothing_and_blocks_nobody(self):
        begun = {}
        for name in "P1", "P2", "P11", "P1-2":
            index = records.Participants(self.path).index_of(name)
            records.Participants(self.path).register(name)
            begun[name] = trials.schedule(CLIPS, index, 1)
            self.append(name, begun[name][0], "movement", 3)
            records.append_row(self.path, ".briefings", ["participant", "check"], [name, "consent"])
            records.append_row(self.path, ".presentations", records.PRESENTATION_COLUMNS,
                               [name, 1, f"{name}-1", 1, "a, b", ""])
            # The last one was interrupted before it was a presentation.
            chain.add(self.path, "clip", f"{name}-1")
            for trace in f"{name}-1.haptic.csv", f"{name}-12.csv":
                Path(f"{self.path}.traces").mkdir(exist_ok=True)
                Path(f"{self.path}.traces/{trace}").touch()
        participants = records.Participants(self.path)
        with self.assertRaisesRegex(ValueError, 'nobody in it is called "P3"'):
            participants.withdraw("P3")
        participants.withdraw("P1")
        self.assertEqual({file.name for file in Path(f"{self.path}.traces").iterdir()},
                         {f"{name}-{rest}.csv" for name in ("P2", "P11", "P1-2") for rest in ("1.haptic", "12")})
        for file in self.path.parent.rglob("*"):
            if file.is_file():
                self.assertNotRegex(file.read_text(), r"\bP1\b(?!-2)", file)
        answers = records.read_answers(self.path)
        self.assertEqual([answer.participant for answer in answers], ["P2", "P11", "P1-2"])
        participants = records.Participants(self.path)
        self.assertEqual(len(chain.named(self.path, "withdrawn")), 1)
        for name, index in ("P2", 1), ("P11", 2):
            self.assertEqual(participants.index_of(name), index)
            trials.open_questions(answers, name, begun[name], {})  # goes on as it began
        self.assertEqual(participants.index_of("P4"), 0, "the next one takes the place")
        participants.register("P4")
        self.assertEqual(records.Participants(self.path).index_of("P5"), 4)

    def test_settings_stay_as_they_were(self):
        settings = {"seed": 1, "clips_sha256": {"a.avi": "1f"}, "device": "sim"}
        self.assertIsNone(records.read_settings(self.path))
        records.write_settings(self.path, settings, {"a.avi": {}})
        records.require_same(self.path, records.read_settings(self.path), dict(settings))
        for changed, message in [({"seed": 2}, "seed was 1, not 2"), ({"device": "usb"}, 'device was "sim", not "usb"'),
                                 ({"clips_sha256": {"a.avi": "20"}}, 'clips_sha256 a.avi was "1f", not "20"'),
                                 ({"host": "x"}, 'host was null, not "x"')]:
            with self.assertRaisesRegex(ValueError, re.escape(message)):
                records.require_same(self.path, records.read_settings(self.path), settings | changed)
        self.assertEqual(records.read_settings(self.path, "preview"), {"a.avi": {}})
        for wrong in (b"", b"{", b"[]", b"{}", b"\xff", b'{"a":' + b"[" * 100000 + b"]" * 100000 + b"}"):
            Path(f"{self.path}.settings.json").write_bytes(wrong)
            with self.assertRaisesRegex(ValueError, "settings.json: is not as this program wrote it"):
                records.read_settings(self.path)
        Path(f"{self.path}.settings.json").unlink()
        self.append("P1", trials.schedule(CLIPS, 0, 1)[0], "movement", 3)
        with self.assertRaisesRegex(ValueError, "settings.json: is missing"):
            records.read_settings(self.path)

    def test_says_what_is_wrong_and_where(self):
        header = ",".join(records.COLUMNS) + "\n"
        good = "P1,1,controllers,linear,A2,a.avi,movement,3,now\n"
        for content, message in [
                ("hello\n", "answers.csv:1: not a file of answers"),
                (header + good + "P1,2\n", "answers.csv:3: 2 columns"),
                (header + good.replace(",3,", ",6,"), '"6" is not a number from 1 to 5'),
                (header + good.replace("linear", "sham"), '"controllers, sham" is not a part'),
                (header + good.replace(",1,", ",one,"), '"one" is not a number of a trial')]:
            self.path.write_text(content)
            with self.assertRaisesRegex(ValueError, re.escape(message)):
                records.read_answers(self.path)
        self.path.write_text(header + good)
        self.assertEqual(len(records.read_answers(self.path)), 1)
        for table, content, message in [
                (".presentations", "participant,trial\n", ":1: there is no column delivered_fraction, problem, trace"),
                (".briefings", "participant,check,answer\nP1,consent\n", ":2: 2 columns, not 3"),
                (".exports", 'folder,time_utc\n"/a"b",now\n' + "x" * 200000 + ",now\n", ":3: field larger than"),
                (".participants", "participant,index\nP1,first\n", ': "first" of P1 is not a whole number')]:
            Path(f"{self.path}{table}").write_text(content)
            with self.assertRaisesRegex(ValueError, re.escape(f"{self.path}{table}{message}")):
                records.Participants(self.path) if table == ".participants" else records.read_rows(f"{self.path}{table}")


class Repeated(InFolder):
    def test_a_trial_is_repeated_and_never_asked_about_if_it_fails(self):
        options = Namespace(answers=str(self.path), participant="P1")
        trial = trials.schedule(CLIPS, 0, 1)[0]
        with patch.object(study.Study, "__init__", lambda self, options: setattr(self, "options", options)):
            one = study.Study(options)
        for problems, lines in (["weak", ""], ["", "", "4"]), (["weak"] * 3, [""] * 3 + ["4"]):
            with patch.object(one, "present", side_effect=problems) as present, typed(lines), \
                    contextlib.redirect_stdout(io.StringIO()):
                try:
                    one.run_trial(None, trial, None, {"movement": "?"})
                except RuntimeError as error:
                    self.assertIn("trial 1 failed 3 times, and its answers would say nothing", str(error))
                    self.assertNotIn("weak", str(error), "the participant may look on")
            self.assertEqual(present.call_count, len(problems))
        self.assertEqual([answer.answer for answer in records.read_answers(self.path)], [4])


class Preview(unittest.TestCase):
    """Forces of clips whose speeds are known, by equations 11 to 15."""

    def compare(self, speeds_px_s, alpha_s_px=0.0025, is_matched=True):
        fastest, forces_N = 0, {"linear": [], "nonlinear": [], "sham": []}
        for speed in speeds_px_s:
            fastest = max(fastest, speed, 1e-9)
            forces_N["linear"].append(speed / fastest)
            forces_N["nonlinear"].append(2 / math.pi * math.atan(alpha_s_px * speed))
        forces_N["sham"] = [0.8 * force for force in forces_N["nonlinear"]]
        return preview.compare(forces_N, 1.0, is_matched)

    def test_conditions_are_equally_strong_unless_it_is_the_papers_setting(self):
        speeds = [300 * abs(math.sin(n / 10)) for n in range(200)]
        clip = self.compare(speeds)
        played = [clip.max_force_N[name] * clip.rms_N[name] for name in preview.FORCES]
        self.assertAlmostEqual(min(played), max(played), 12)
        self.assertEqual(max(clip.max_force_N.values()), 1, "the limit of the study is kept")
        self.assertEqual(set(self.compare(speeds, is_matched=False).max_force_N.values()), {1})

    def test_nonlinear_is_stronger_at_low_speed_only_in_fast_films(self):
        """Only if the fastest speed is above π / (2 α): 628 px/s here."""
        rise = [n / 200 for n in range(200, 0, -1)]
        slow, fast = (self.compare([speed * top for speed in rise], is_matched=False) for top in (600, 1800))
        self.assertEqual(slow.stronger, 0)
        self.assertGreater(fast.stronger, 0.5)

    def by_alpha(self, speeds_px_s):
        return {alpha: self.compare(speeds_px_s, alpha) for alpha in preview.ALPHAS_S_PX}

    def test_refuses_clips_that_are_mostly_the_same(self):
        choose = lambda name, speeds, accept=False: preview.choose({name: {0.0025: self.compare(speeds)}}, accept)
        choose("good.avi", [1000, 500, 200, 50] * 20)
        # At equal strength, 0.709 and 0.705 of the limit at 800 px/s, and 0.071 and 0.126 at 80 px/s.
        for speeds, percent in ([200] * 100, 0), ([800] * 70 + [80] * 30, 30):
            with self.assertRaisesRegex(ValueError, f"steady.avi: linear and nonlinear can be told apart in {percent} % of"):
                choose("steady.avi", speeds)
            choose("steady.avi", speeds, True)
        for accept in False, True:
            with self.assertRaisesRegex(ValueError, "still.avi: no frame of it has a force"):
                choose("still.avi", [0] * 100, accept)

    def test_names_the_clips_at_fault_and_no_other(self):
        """In any order; a good clip needs another alpha than the smallest, which is taken where the others are accepted."""
        sway, steady, still = ([150 * abs(math.sin(n / 10)) for n in range(200)], [200] * 100, [0] * 100)
        best = preview.choose({"sway.avi": self.by_alpha(sway)})
        self.assertGreater(best, preview.ALPHAS_S_PX[0])
        for bad, said in (("still.avi", still), "still.avi: no frame"), (("steady.avi", steady), "steady.avi: linear and nonlinear"):
            for clips in ([("sway.avi", sway), bad], [bad, ("sway.avi", sway)]):
                with self.assertRaisesRegex(ValueError, said) as caught:
                    preview.choose({name: self.by_alpha(speeds) for name, speeds in clips})
                self.assertNotIn("sway", str(caught.exception))
        self.assertEqual(preview.choose({"steady.avi": self.by_alpha(steady), "sway.avi": self.by_alpha(sway)}, True), best)

    def test_takes_the_smallest_alpha_with_which_all_clips_differ(self):
        sway = self.by_alpha([150 * abs(math.sin(n / 10)) for n in range(200)])
        shares = [clip.apart for clip in sway.values()]
        self.assertLess(shares[0], preview.LEAST_APART, "slow motion: both are proportional to speed")
        self.assertGreaterEqual(shares[-1], preview.LEAST_APART)
        best = preview.choose({"sway.avi": sway})
        self.assertEqual(best, min(alpha for alpha, clip in sway.items() if clip.apart >= preview.LEAST_APART))
        fast = self.by_alpha([1500 * abs(math.sin(n / 10)) for n in range(200)])
        self.assertEqual(preview.choose({"fast.avi": fast}), preview.ALPHAS_S_PX[0])
        self.assertEqual(preview.choose({"fast.avi": fast, "sway.avi": sway}), best)
        self.assertIn("0.04 ", preview.table({"sway.avi": sway}))


class Perception(unittest.TestCase):
    TRUE = 0.05  # N: the threshold of the simulated person, at which 70.7 % are right

    def chance(self, level):
        """A Weibull function of two alternatives with a slope of 3, usual for touch."""
        return 1 - 0.5 * math.exp(math.log(2 * (1 - 0.5**0.5)) * (level / self.TRUE)**3)

    def found(self, source, person, count):
        """The thresholds of `count` people, as natural logarithms of the true one, and the numbers of trials."""
        logs, trials = [], []
        for _ in range(count):
            stairs = perception.Staircase(0.25, 1.0)
            while not stairs.is_done():
                self.assertLessEqual(stairs.level, 1.0)
                stairs.answer(source.random() < person(stairs.level))
            trials.append(stairs.trials)
            logs += [math.log(stairs.threshold() / self.TRUE)] if stairs.threshold() else []
        return logs, trials

    def test_a_threshold_is_that_of_a_simulated_person(self):
        """Also of who lapses in 5 % of the trials."""
        for lapses in 0, 0.05:
            person = lambda level, lapses=lapses: lapses / 2 + (1 - lapses) * self.chance(level)
            logs, trials = self.found(random.Random(1), person, 40)
            self.assertGreaterEqual(len(logs), 36)
            self.assertLess(abs(statistics.fmean(logs)), 0.2 + 0.1)  # 40 people: twice 0.3 / √40
            self.assertLess(statistics.stdev(logs), 0.45)
            trial_s = 2 * (perception.PULSE_S + 2 * perception.RAMP_S + perception.PAUSE_S) + 1  # a second for the answer
            self.assertLess(statistics.fmean(trials) * trial_s, 2.5 * 60)

    def test_who_guesses_has_no_threshold_and_no_force_above_the_limit(self):
        self.assertLessEqual(len(self.found(random.Random(2), lambda level: 0.5, 40)[0]), 2)

    def test_a_person_is_measured_by_what_the_device_is_told(self):
        """The simulated person feels what is pushed and when, and tells each apart from a threshold of its own on."""
        true = {"felt_N": 0.05, "weber": 0.2, "turned_deg": 15, "late_ms": 60}
        pushed, late_ms, source = [[]], [], random.Random(3)
        device = Namespace(push=lambda force_N: pushed[-1].append(force_N) or True)
        picture = Namespace(move=lambda push: push(0))
        sleep = lambda seconds: pushed.append([]) if seconds == perception.PAUSE_S else None

        def levels(name):
            """Of both intervals."""
            if name == "late_ms":
                return late_ms[-2:]
            first, second = (max(pulse, key=lambda force_N: math.hypot(*force_N)) for pulse in pushed[-3:-1])
            if name == "turned_deg":
                return [math.degrees(math.atan2(force_N[1], force_N[0])) for force_N in (first, second)]
            return [first[0], second[0]] if name == "felt_N" else [force_N[0] / 0.5 - 1 for force_N in (first, second)]

        def ask(name):
            first, second = levels(name)
            is_right = source.random() < self.chance(max(first, second) / true[name] * self.TRUE)
            return 1 if (first > second) == is_right else 2

        self.assertEqual(list(perception.blocks(device, 1.0, picture)), list(perception.THRESHOLDS))
        for name in true:
            found = []
            for _ in range(8):
                staircase, present, _ = perception.blocks(device, 1.0, picture, sleep)[name]
                with patch.object(perception, "sleep_until", lambda time_ns: late_ms.append(time_ns / 1e6)):
                    found.append(perception.measure(present, staircase, lambda name=name: ask(name), source, sleep))
            logs = [math.log2(each / true[name]) for each in found if each]
            self.assertGreaterEqual(len(logs), 7, name)
            # Of eight, each with a scatter of less than half an octave; and a bias.
            self.assertLess(abs(statistics.fmean(logs)), 1 / 4 + 4 * 0.5 / math.sqrt(len(logs)), name)
        sizes = [[math.hypot(*force_N) for force_N in pulse] for pulse in pushed]
        steps = [abs(b - a) for pulse in sizes for a, b in zip([0, *pulse], [*pulse, 0])]
        self.assertLess(max(steps), 1.0 * math.pi / 2 * perception.SAMPLE_S / perception.RAMP_S + 1e-9, "no tap")
        self.assertLessEqual(max(map(max, filter(None, sizes))), 1.0 + 1e-9, "no more than the limit")

    def test_the_square_moves_when_it_says(self):
        """The first picture that differs is due on the screen at the time that is told, and a force of this time begins then."""
        shown, told_ns = [], []
        with moving_square.MovingSquare("headless") as square:
            sink = next(each for each in square.pipeline.children if each.get_name().startswith("fakesink"))

            def note(_, info):
                buffer = info.get_buffer()
                shown.append((buffer.pts, buffer.extract_dup(0, buffer.get_size())))
                return clip_player.Gst.PadProbeReturn.OK

            sink.get_static_pad("sink").add_probe(clip_player.Gst.PadProbeType.BUFFER, note)
            now_ns = time.monotonic_ns()
            square.move(told_ns.append)
            square.pipeline.get_by_name("source").emit("end-of-stream")
            square.pipeline.bus.timed_pop_filtered(60 * clip_player.Gst.SECOND, clip_player.Gst.MessageType.EOS)
            base_ns = square.pipeline.get_base_time()
        moved = next(pts for (pts, picture), (_, before) in zip(shown[1:], shown) if picture != before)
        frame_ns = 1e9 / moving_square.FRAMES_S
        self.assertLessEqual(0, base_ns + moved - told_ns[0])
        self.assertLess(base_ns + moved - told_ns[0], 3 * frame_ns, "its first steps are less than a pixel")
        self.assertGreater(told_ns[0], now_ns, "it is known before")

    def test_a_device_that_is_lost_ends_it(self):
        device = Namespace(push=lambda force_N: False, last_fault=lambda: "unplugged")
        with self.assertRaisesRegex(RuntimeError, "takes no force: unplugged"):
            perception.pulse(device, 0.5, lambda seconds: None)


class Noise(unittest.TestCase):
    def test_plays_until_the_session_ends_unless_it_is_turned_off(self):
        state = lambda pipeline: pipeline.get_state(60 * clip_player.Gst.SECOND)[1]
        for volume, expected in (0.1, clip_player.Gst.State.PLAYING), (0, clip_player.Gst.State.NULL):
            with clip_player.noise(volume, "headless") as pipeline:
                self.assertEqual(state(pipeline), expected)
            self.assertEqual(state(pipeline), clip_player.Gst.State.NULL)


class Terminal(unittest.TestCase):
    def test_asks_until_there_is_an_answer(self):
        out = io.StringIO()
        with typed(["", "6", "very good", "4", "q"]), contextlib.redirect_stdout(out):
            self.assertEqual(briefing.ask("How real?"), 4)
            for _ in "q", "the end of input":
                with self.assertRaises(briefing.Stopped):
                    briefing.ask("How real?")
        self.assertIn("How real?\n  1 bad  2 poor  3 average  4 good  5 very good", out.getvalue())


class OnATerminal(unittest.TestCase):
    def test_what_was_typed_before_a_question_is_no_answer(self):
        script = (f"import sys; sys.path.insert(0, {FOLDER!r}); import briefing; briefing.WORDS_S = 1e9; input(); "
                  "print(briefing.is_yes('Consent?'))")
        process, terminal = pty.fork()
        if process == 0:
            os.execl(sys.executable, sys.executable, "-c", script)
        os.write(terminal, b"begin\nyes\nyes\n")
        printed = b""
        with contextlib.suppress(OSError):  # its end
            while part := os.read(terminal, 256):
                printed += part
                if printed.endswith(b"yes or no > "):
                    os.write(terminal, b"no\n")
        os.close(terminal)
        self.assertEqual(os.waitpid(process, 0)[1], 0)
        self.assertEqual(printed.split()[-1], b"False", printed)

    def answer(self, typed_after_s):
        """What is taken for an answer to a question of 15 words, with its prompt, of lines that are typed so long after it."""
        times_s = [each for n, after_s in enumerate(typed_after_s) for each in (1000 * n, 1000 * n + after_s)]
        with patch.object(sys.stdin, "isatty", lambda: True), patch.object(briefing.termios, "tcflush"), \
                patch.object(briefing.time, "monotonic", side_effect=times_s), \
                patch("builtins.input", side_effect=[str(n % 5 + 1) for n in range(len(typed_after_s))]), \
                contextlib.redirect_stdout(io.StringIO()) as out:
            answer = briefing.ask("How is that?")
        return answer, out.getvalue().count("nobody can read that so fast")

    def test_what_comes_sooner_than_a_question_is_read_is_no_answer(self):
        briefing.texts_read.clear()
        self.assertEqual(self.answer([0.1, 2.9, 3.1]), (3, 2))
        self.assertEqual(self.answer([0.1]), (1, 0), "it was read before")
        briefing.texts_read.clear()
        self.assertEqual(self.answer([2.9, 3.1]), (2, 1))


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
        record = Path(f"{self.path}.briefings")
        return record.read_text() if record.exists() else ""

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

    def test_a_participant_is_described_and_debriefed_once(self):
        with typed(["3", "2", "q"]), self.assertRaises(briefing.Stopped):
            briefing.describe(self.path, "P1")
        with typed(["4", "1"]), contextlib.redirect_stdout(io.StringIO()):  # there is no fourth answer
            briefing.describe(self.path, "P1")
        with typed([]):
            briefing.describe(self.path, "P1")
        for answer in "P1,handedness,both,20", "P1,grip-hand,left,20", "P1,experience,never,20":
            self.assertIn(answer, self.record())
        with typed(["sometimes it went up, or down", "3"]), contextlib.redirect_stdout(io.StringIO()):
            briefing.debrief(self.path, "P1")
        self.assertIn('P1,guess,"sometimes it went up, or down",20', self.record())
        self.assertIn("P1,believed,it was at times against the motion,20", self.record())
        with typed([]):
            briefing.debrief(self.path, "P1")

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


if __name__ == "__main__":
    unittest.main()
