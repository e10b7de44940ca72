#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The study as it is carried out, from the number of participants to the table, with simulated participants.

    test_study_run.py FOLDER-OF-STUDY.PY
"""

import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import briefing  # noqa: E402
import chain  # noqa: E402
import clip_player  # noqa: E402
import gst_spidar  # noqa: E402
import perception  # noqa: E402
import records  # noqa: E402

SECONDS, FRAMES_S = 1.5, 25
HANGS_S = 300  # without a word; a busy machine takes a part of it to start a program
CONDITION_WORDS = ["linear", "without haptics", "with haptics", "sham"]


def make_clip(folder, name):
    """A textured disc that sways before a plain wall, slowly and fast, so that the controllers differ."""
    def picture(n):
        t = n / FRAMES_S
        x = 160 + 90 * math.sin(2 * math.pi * 1.2 * t * t)
        rows = []
        for y in range(240):
            row = bytearray(b"\x60" * 320)
            half = 45**2 - (y - 120)**2
            if half > 0:
                half = int(math.sqrt(half))
                for column in range(int(x) - half, int(x) + half):
                    u, v = (column - x) / 6, (y - 120) / 6
                    row[column] = int(128 + 60 * math.sin(u) * math.cos(0.8 * v + u / 3))
            rows.append(bytes(row))
        return b"".join(rows)

    clip = Path(folder, name)
    frames = b"".join(picture(n) for n in range(int(SECONDS * FRAMES_S)))
    subprocess.run(["gst-launch-1.0", "-q", "fdsrc", "!", "rawvideoparse", "format=gray8", "width=320", "height=240",
                    f"framerate={FRAMES_S}/1", "!", "jpegenc", "quality=95", "!", "avimux", "!", "filesink",
                    f"location={clip}"], input=frames, check=True)
    return clip


def study(*arguments, lines=()):
    return subprocess.run([sys.executable, FOLDER + "/study.py", *map(str, arguments)], text=True, capture_output=True,
                          input="".join(line + "\n" for line in lines), timeout=HANGS_S)


class SimulatedParticipant:
    """Reads what is asked and answers it: at random, but by one step higher where something is felt."""
    BRIEFING = ["yes", *["no"] * len(briefing.EXCLUSIONS), "yes"]
    PERSON = ["1"] * len(briefing.PERSON)

    def __init__(self, answers, name, clips, *more):
        self.command = [sys.executable, "-u", FOLDER + "/study.py", "run", "--headless", answers, name, *clips, *more]
        self.answers, self.name, self.random = answers, name, random.Random(name)

    def take_part(self, trials_at_most=None):
        """All that was printed. Goes on in another session where the machine was too slow for a presentation."""
        for _ in range(20):
            printed, code = self.session(trials_at_most)
            if not (code == 1 and "failed 3 times" in printed):
                return printed, code
        return printed, code

    def session(self, trials_at_most):
        briefed, seen, printed, line = iter(self.BRIEFING), 0, "", ""
        with subprocess.Popen(self.command, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT) as process:
            hangs = threading.Timer(HANGS_S, process.kill)
            hangs.start()

            def type_(text):
                nonlocal hangs
                hangs.cancel()
                hangs = threading.Timer(HANGS_S, process.kill)
                hangs.start()
                process.stdin.write(text + "\n")
                process.stdin.flush()

            while character := process.stdout.read(1):
                line += character
                printed += character
                if line.endswith("yes or no > "):
                    type_(next(briefed))
                elif line.endswith("another time > "):
                    type_("q" if seen == trials_at_most else "")
                elif line.endswith("\n> "):
                    type_(str(min(5, self.random.randint(1, 4) + self.random.randint(0, 1))))
                elif "code " in line and line.endswith("\n"):
                    seen += "clip" in line
                else:
                    continue
                line = ""
            code = process.wait()
            hangs.cancel()
        return printed, code


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder, cls.clip = Path(folder.name), make_clip(folder.name, "sway.avi")

    def file(self, name):
        return self.folder / name

    def test_from_recruiting_to_a_table(self):
        answers = self.file("answers.csv")
        planned = study("plan", "--odds-ratio", 50)
        self.assertRegex(planned.stdout, r"\d+ participants are enough", planned)
        shown = study("design", self.clip)
        self.assertRegex(shown.stdout, r"(?m)^0.0025 +\d+ .*sway.avi$", shown)
        self.assertRegex(shown.stdout, r"run takes alpha=0\.\d+ s/px", shown)
        os.link(self.clip, self.file("link.csv"))
        self.assertIn("which is read", study("register", "--participants", 3, self.file("link.csv"), self.clip).stderr)
        registered = study("register", "--participants", 3, answers, self.clip)
        made, code = records.digest_of(records.read_settings(answers)), chain.codes(answers)[0]
        self.assertRegex(registered.stdout, rf"(?s)consent: {code}\n.*3 participants, 1 clips.*Settings: SHA-256 {made}.* {code}", registered)
        again = study("register", "--participants", 5000, answers, self.clip)
        self.assertEqual((again.returncode, again.stdout), (2, ""), again)
        self.assertRegex(again.stderr, "participants was 3, not 5000.*nothing is registered, and a code above is void")
        first, code = SimulatedParticipant(answers, "P01", [self.clip]).take_part(trials_at_most=2)
        self.assertIn("stopped; the same command goes on here", first)
        self.assertEqual((code, len(records.read_answers(answers)) > 0), (0, True))
        people = ["P01", "P02", "P03"]
        for name in people:
            printed, code = SimulatedParticipant(answers, name, [self.clip]).take_part()
            self.assertEqual((code, printed.count("that was all")), (0, 1), printed)
            after = printed[printed.index("code "):]
            for word in CONDITION_WORDS:
                self.assertNotIn(word, first[first.index("code "):] + after, "only the code is shown")
            self.assertNotRegex(first + printed, r"\d N\b|\bapart\b|max-force|rms", "nor how strong anything is")
        self.check_presentations(answers, people)
        left = study("withdraw", answers, "P01")
        self.assertEqual(left.returncode, 0, left)
        printed, code = SimulatedParticipant(answers, "P04", [self.clip]).take_part()
        self.assertEqual((code, printed.count("that was all")), (0, 1), printed)
        table = study("report", answers).stdout
        self.assertIn("withdrew: 1", table)
        self.assertIn("look 1, at 3 of 3 participants", table)
        self.assertIn(re.search(r"Note with the form of consent: (\w{8})\n", printed)[1], table)
        self.assertRegex(table, r"haptics: reality +sham +3 ")
        self.assertRegex(table, r"(?m)^controllers: movement +linear, nonlinear +3 +1  [+-]\d")
        self.check_what_must_not_change(answers)

    def check_presentations(self, answers, people):
        asked = records.read_answers(answers)
        shown = [row for row in records.read_rows(f"{answers}.presentations") if not row["problem"]]
        clip, = records.read_settings(answers, "preview").values()
        rms_N = {}
        for name in people:
            given = [answer for answer in asked if answer.participant == name]
            self.assertEqual(len(given), 2 + 3 * 3)
            traces = {row["trial"]: row["trace"] for row in shown if row["participant"] == name}
            for trial, condition in {(answer.trial, answer.condition) for answer in given}:
                rows = [row for row in records.read_rows(f"{answers}.traces/{traces[str(trial)]}.haptic.csv")
                        if row["playing"] == "1"]
                wanted, delivered = ([[float(row[f"{which}_force_{axis}_N"]) for axis in "xyz"] for row in rows]
                                     for which in ("wanted", "delivered"))
                rms_N[name, condition] = math.sqrt(sum(v * v for row in wanted for v in row) / len(rows))
                if condition == "without":
                    self.assertLess(max(math.hypot(*row) for row in delivered), 0.04, "a hand feels nothing")
                else:
                    self.assertGreater(max(math.hypot(*row) for row in delivered), 0.04)
                self.assertLessEqual(max(math.hypot(*row) for row in wanted), briefing.GENTLE_N + 1e-6)
        target_N = min(clip["rms_N"].values())
        for (name, condition), rms in rms_N.items():
            # What counts is within 11 % of the force that was measured before, and that is matched exactly.
            self.assertAlmostEqual(rms, 0 if condition == "without" else target_N, delta=0.115 * target_N)

    def check_what_must_not_change(self, answers):
        for more, message in ([["--seed", "2"], "seed was 1, not 2"], [["--", "device=sim", "alpha=0.01"], "properties was"],
                              [["--paper"], "paper was false, not true"],
                              [["--primary", "reality"], 'analysis primary was "movement", not "reality"'],
                              [["--accept-alike"], "accept_alike was false, not true"]):
            split = more.index("--") if "--" in more else len(more)
            refused = study("run", "--headless", *more[:split], answers, "P02", self.clip, *more[split:])
            self.assertEqual((refused.returncode, message in refused.stderr), (2, True), refused)
        content = self.clip.read_bytes()
        self.addCleanup(self.clip.write_bytes, content)
        self.clip.write_bytes(content + b"\0")
        refused = study("run", "--headless", answers, "P02", self.clip)
        self.assertEqual((refused.returncode, "clips_sha256" in refused.stderr), (2, True), refused)

    def test_a_moved_folder_goes_on_and_a_killed_clip_is_named(self):
        """The clip, too, under another name; the session is killed in its first clip."""
        answers, moved = self.file("begun") / "answers.csv", self.file("moved")
        killed = False
        while not killed:  # again, where a busy machine kills it after the clip
            shutil.rmtree(answers.parent, ignore_errors=True)
            answers.parent.mkdir()
            (answers.parent / "clip.avi").write_bytes(self.clip.read_bytes())
            self.assertEqual(study("register", "--participants", 1, answers, answers.parent / "clip.avi").returncode, 0)
            with subprocess.Popen([sys.executable, "-u", FOLDER + "/study.py", "run", "--headless", answers, "P01",
                                   answers.parent / "clip.avi"], text=True, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as process:
                process.stdin.write("\n".join([*SimulatedParticipant.BRIEFING, *SimulatedParticipant.PERSON, "", ""]))
                process.stdin.flush()
                while "P01-1" not in chain.named(answers, "clip"):
                    self.assertIsNone(process.poll(), "it has ended before the clip")
                    time.sleep(0.05)
                process.kill()
            killed = not records.read_rows(f"{answers}.presentations")
        answers.parent.rename(moved)
        (moved / "clip.avi").rename(moved / "film.avi")
        printed, code = SimulatedParticipant(moved / "answers.csv", "P01", [moved / "film.avi"]).take_part()
        self.assertEqual((code, printed.count("that was all")), (0, 1), printed)
        table = study("report", moved / "answers.csv").stdout
        self.assertIn("the session was killed in P01-1", table)
        self.assertNotIn("EXPLORATORY", table)

    def test_a_clip_to_practise_with_comes_first_and_is_not_an_answer(self):
        answers, other = self.file("practice.csv"), self.file("other.avi")
        other.write_bytes(self.clip.read_bytes() + b"\0")
        lines = [*SimulatedParticipant.BRIEFING, *SimulatedParticipant.PERSON, *["", "3", "3", "3"] * 2, "q"]
        for practised in 2, 2:  # and not again in the next session
            done = study("run", "--headless", "--practice", other, answers, "P01", self.clip, lines=lines)
            self.assertEqual((done.returncode, "the same command goes on here" in done.stdout), (0, True), done)
            self.assertEqual([row["trial"] for row in records.read_rows(f"{answers}.presentations")], ["0"] * practised)
            lines = [*SimulatedParticipant.BRIEFING, "q"]
        self.assertEqual(records.read_answers(answers), [])
        refused = study("run", "--headless", answers, "P01", self.clip)
        self.assertIn("practice was", refused.stderr)

    def test_a_recorder_of_the_laboratory_gets_trials_and_forces(self):
        """By a stand-in for examples/lsl.py, whose own streams test_lsl.py receives."""
        sent = self.file("sent")
        stand_in = self.file("lsl")
        stand_in.mkdir()
        (stand_in / "lsl.py").write_text(f"""
def load(): return None
class Streams:
    def __init__(self, lsl, source): self.out = open({str(sent)!r}, "w", buffering=1)
    def mark(self, text, monotonic_ns): print(monotonic_ns, text, file=self.out)
    def add(self, row): print(row["monotonic_ns"], row["delivered_force_x_N"], file=self.out)
""")
        with patch.dict(os.environ, {"PYTHONPATH": f"{stand_in}:{os.environ.get('PYTHONPATH', '')}"}):
            SimulatedParticipant(self.file("lsl.csv"), "P01", [self.clip], "--lsl").take_part(trials_at_most=2)
        rows = [line.split(" ", 1) for line in sent.read_text().splitlines()]
        marks = [(int(ns), text) for ns, text in rows if "trial" in text]
        self.assertRegex(" ".join(text for _, text in marks[:2]), r"^begin trial 1 code [A-Z]\d end trial 1$")
        during = [float(text) for ns, text in rows if "trial" not in text and marks[0][0] < int(ns) < marks[1][0]]
        self.assertGreater(len(during), 0)

    def test_thresholds_are_measured_on_the_device(self):
        answers = self.file("thresholds.csv")
        done = study("threshold", answers, "P01", "--noise", 0,
                     lines=[*SimulatedParticipant.BRIEFING, *SimulatedParticipant.PERSON, "1", "2", "q"])
        self.assertEqual((done.returncode, done.stdout.count("When was the force larger?")), (0, 3), done)
        for name, question in ("turned_deg", "When did the force point higher?"), ("late_ms", "later than the square moved?"):
            done = study("threshold", "--headless", "--block", name, "--noise", 0, answers, "P01",
                         lines=[*SimulatedParticipant.BRIEFING, "1", "q"])
            self.assertEqual((done.returncode, done.stdout.count(question)), (0, 2), done)
        self.assertEqual(records.read_rows(f"{answers}.thresholds"), [], "not complete")
        with gst_spidar.Device("sim") as device:
            device.set_limits(1, 0)
            self.assertTrue(device.wait_until_running(60))
            felt_N = [0.0]
            while max(felt_N) < 0.5 * (1 - perception.WEBER):  # again, where a busy machine leaves its top out
                felt_N = []
                perception.pulse(device, 0.5, lambda seconds: (felt_N.append(device.felt().force_N.x), time.sleep(seconds)))
        # The strings of the simulated device deliver what they can at its pose, at the centre nearly all.
        self.assertAlmostEqual(max(felt_N), 0.5, delta=perception.WEBER * 0.5)
        self.assertAlmostEqual(felt_N[0], 0, delta=perception.FELT_N)

    def test_the_sham_pulls_the_other_way_as_strongly(self):
        forces_N = []
        for is_turned in False, True:
            trace = self.file(f"turned-{is_turned}.csv")
            with clip_player.Player(["device=none"], "fast") as player:
                player.play(str(self.clip), [f"trace={trace}"], is_turned)
            forces_N.append([[float(row[f"force_{axis}_N"]) for axis in "xy"] for row in records.read_rows(trace)])
        real, sham = forces_N
        product = lambda a, b: sum(p * q for pair in zip(a, b) for p, q in zip(*pair))
        # The same blocks of the same picture, in another order: not to the bit, but as far as a hand can tell (11 %).
        self.assertLess(product(sham, real), -0.89 * product(real, real))
        self.assertAlmostEqual(product(sham, sham), product(real, real), delta=0.22 * product(real, real))

    def test_one_opening_of_the_device_serves_all_clips(self):
        """So the position of the grip has one centre."""
        traces = [self.file("first.csv"), self.file("second.csv")]
        with clip_player.Player(["device=sim", "max-force=1"], "headless") as player:
            for trace in traces:
                self.assertTrue(player.play(str(self.clip), [f"trace={trace}.frames.csv"], haptic_trace=trace))
        ticks = [[int(row["tick"]) for row in records.read_rows(trace)] for trace in traces]
        self.assertGreater(len(ticks[0]), 0)
        self.assertGreater(ticks[1][0], ticks[0][-1])
        self.assertEqual(ticks[1], sorted(set(ticks[1])))

    def test_the_screen_trace_has_when_the_sink_showed_each_frame(self):
        """Of a sink that stands still at the tenth: by so much later than they should be at least, whatever the machine does."""
        trace, player, slept_s = self.file("screen.csv"), clip_player.Player(["device=none"], "headless"), 0.3

        def slow(sink, buffer, _):
            slow.count += 1
            slow.base_s = player.pipeline.get_base_time() / 1e9  # of the clock of the pipeline, CLOCK_MONOTONIC
            if slow.count == 10:
                time.sleep(slept_s)
        slow.count = 0
        open_clip = player.open_clip

        def open_slow(*arguments):
            open_clip(*arguments)
            player.screen.sink().set_property("signal-handoffs", True)
            player.screen.sink().connect("handoff", slow)

        with patch.object(player, "open_clip", open_slow), player:
            player.play(str(self.clip), [], screen_trace=trace)
        rows = [(int(row["running_ns"]) / 1e9, int(row["shown_ns"]) / 1e9) for row in records.read_rows(trace)]
        self.assertEqual(len(rows), int(SECONDS * FRAMES_S))
        for n, (running_s, shown_s) in enumerate(rows):
            self.assertAlmostEqual(running_s, n / FRAMES_S, 6)
            self.assertGreaterEqual(shown_s, slow.base_s + running_s, "none before it is due")
        self.assertGreaterEqual(rows[9][1] - rows[8][1], slept_s)

    @unittest.skipUnless(shutil.which("Xvfb"), "no Xvfb")
    def test_the_film_fills_the_screen_until_it_ends(self):
        """A white picture of another shape, on the screen of 300 × 200: white in its middle, black at its border."""
        reader, writer = os.pipe()
        server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "300x200x24", "-nolisten", "tcp"],
                                  pass_fds=[writer], stderr=subprocess.DEVNULL)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        os.close(writer)
        with os.fdopen(reader) as numbers:
            display = ":" + numbers.readline().strip()
        script = f"""if True:
            import ctypes, sys
            sys.path.insert(0, {FOLDER!r})
            import clip_player, full_screen
            Gst = clip_player.Gst
            x = ctypes.CDLL("libX11.so.6")
            class Image(ctypes.Structure):
                _fields_ = [(name, ctypes.c_int) for name in ("width", "height", "offset", "format")] + [("data", ctypes.c_void_p)]
            x.XOpenDisplay.restype, x.XDefaultRootWindow.restype, x.XGetImage.restype = ctypes.c_void_p, ctypes.c_ulong, ctypes.POINTER(Image)
            display = ctypes.c_void_p(x.XOpenDisplay(None))
            root = ctypes.c_ulong(x.XDefaultRootWindow(display))
            def pixels():
                image = x.XGetImage(display, root, 0, 0, 300, 200, ctypes.c_ulong(0xffffffff), 2).contents
                data = ctypes.string_at(image.data, 300 * 200 * 4)
                return [data[4 * (300 * row + column)] for row, column in ((100, 150), (10, 150), (190, 150), (100, 5), (100, 295))]
            pipeline = Gst.parse_launch("videotestsrc pattern=white num-buffers=5 ! video/x-raw,width=300,height=100 ! "
                                        "videoconvert ! videoscale ! ximagesink")
            whole = full_screen.FullScreen(pipeline)
            pipeline.set_state(Gst.State.PLAYING)
            message = pipeline.bus.timed_pop_filtered(60 * Gst.SECOND, Gst.MessageType.EOS | Gst.MessageType.ERROR)
            print(message.type == Gst.MessageType.EOS, pixels())
            pipeline.set_state(Gst.State.NULL)
            whole.close()
            print(whole.display, pixels()[0])"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=HANGS_S,
                              env=os.environ | {"DISPLAY": display}, check=False)
        self.assertEqual(done.stdout.splitlines(), ["True [255, 0, 0, 255, 255]", "None 0"], done)

    def test_without_a_board_nobody_is_asked(self):
        answers = self.file("usb.csv")
        unnamed = study("run", "--headless", answers, "P01", self.clip, "--", "device=usb")
        self.assertEqual((unnamed.returncode, "needs profile=NAME" in unnamed.stderr), (2, True), unnamed)
        done = study("run", "--headless", answers, "P01", self.clip, "--", "device=usb", "profile=spidar-g6x3-v2-r",
                     lines=[*SimulatedParticipant.BRIEFING, "yes", "yes", *SimulatedParticipant.PERSON, "", *["", "3"] * 20])
        self.assertEqual((done.returncode, "the device usb cannot be opened" in done.stderr), (1, True), done)
        self.assertEqual(records.read_answers(answers), [])
        none = study("run", "--headless", answers, "P01", self.clip, "--", "device=none")
        self.assertEqual((none.returncode, "device=none renders no force" in none.stderr), (2, True), none)

    def test_a_force_that_comes_too_late_does_not_count(self):
        """By ten seconds: after the clip."""
        answers = self.file("late.csv")
        done = study("run", "--headless", answers, "P01", self.clip, "--", "ts-offset=10000000000",
                     lines=[*SimulatedParticipant.BRIEFING, *SimulatedParticipant.PERSON, *["", "3"] * 20])
        self.assertEqual((done.returncode, "failed 3 times" in done.stderr), (1, True), done)
        self.assertEqual([answer for answer in records.read_answers(answers) if answer.condition != "without"], [])
        problems = [row["problem"] for row in records.read_rows(f"{answers}.presentations")]
        self.assertTrue(any("elsewhere in the clip, for 99" in problem for problem in problems), problems)

    def test_mistakes_are_named(self):
        answers = self.file("mistakes.csv")
        for arguments, message in ([[self.clip, "--", "max-force=much"], "max-force"], [["none.avi"], "none.avi"],
                                   [["--noise", "5", self.clip], "0 to 1"], [["--primary", "joy", self.clip], "movement"],
                                   [["--practice", self.clip, self.clip], "give each clip once"]):
            done = study("run", "--headless", answers, "P01", *arguments)
            self.assertEqual((done.returncode, message in done.stderr), (2, True), done)


if __name__ == "__main__":
    unittest.main()
