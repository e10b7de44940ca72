#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether the study's report names what was changed after it was written, and files of several machines.

    test_study_integrity.py FOLDER-OF-STUDY.PY
"""

import contextlib
import io
import itertools
import json
import random
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import chain  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402
import study_files  # noqa: E402


class Integrity(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.made = cls.study(Path(folder.name, "answers.csv"))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name, "study")
        shutil.copytree(self.made.parent, self.folder)
        self.path = self.folder / "answers.csv"
        for quiet in contextlib.redirect_stdout(io.StringIO()), patch.object(chain.os, "fsync"):
            quiet.__enter__()
            self.addCleanup(quiet.__exit__, None, None, None)

    @staticmethod
    def study(path, people=("P1", "P2", "P3"), **settings):
        source = random.Random(path.name)
        return study_files.write(path, dict.fromkeys(people, lambda *_: source.randint(1, 5)), **settings)

    def report(self, *paths, exploratory=False):
        paths = paths or [self.path]
        return report.report(records.read_merged(paths), paths, exploratory)

    def edit(self, name, old, new, path=None):
        file = Path(f"{path or self.path}{name}")
        text = file.read_text()
        self.assertRegex(text, old)
        file.write_text(re.sub(old, new, text, count=1))

    def require(self, *said):
        """That the report is refused with these words, and is marked if it is made all the same."""
        with self.assertRaises(ValueError) as caught:
            self.report()
        marked = self.report(exploratory=True)
        self.assertIn("EXPLORATORY", marked)
        self.assertIn("(no test)", marked)
        for each in said:
            self.assertIn(each, str(caught.exception))
            self.assertIn(each, marked)

    def test_files_as_they_were_written_fit(self):
        codes = chain.codes(self.path)
        self.assertEqual(len(codes), 4, "the settings, and each participant")
        text = self.report()
        self.assertNotIn("EXPLORATORY", text)
        with_look = chain.codes(self.path)
        self.assertEqual(with_look[:-1], codes, "what was noted stays")
        self.assertIn(f"sessions end with {', '.join(with_look)}", text)
        self.assertRegex(text, rf"registered 20.*Z with {codes[0]};")
        last = Path(f"{self.path}.chain").read_text().splitlines()[-1]
        self.assertTrue(last.split(",")[-1].startswith(with_look[-1]))

    def test_names_what_was_changed(self):
        for name, old, new, said in [
                (".settings.json", '"seed": 1', '"seed": 2', "settings.json: is not as it was written"),
                (".settings.json", '"preview": {}', '"preview": {"a": 0}', "settings.json: is not as it was written"),
                ("", r"\b(non)?linear\b", lambda found: "linear" if found[1] else "nonlinear", "was not written so, or not here: P1,"),
                ("", r"(,[1-5]),now", r"\g<1>,then", "answers.csv:2: was not written so, or not here: P1,"),
                ("", r"\n([^\n]*)\n([^\n]*)\n", r"\n\g<2>\n\g<1>\n", "answers.csv:3: was not written so, or not here: P1,1,"),
                ("", r"\Z", "P3,1,controllers,linear,A2,a.avi,more,3,now", "answers.csv:68: was not written so"),
                (".presentations", "weak", "", "presentations:2: was not written so, or not here: P1,1,P1-1,"),
                (".presentations", r"P1,2,[^\n]*\n", "", "1 of the rows that were written are not in it"),
                (".presentations", "trial,trace", "trace,trial", "presentations:1: was not written so"),
                (".briefings", "P2,consent,yes", "P2,consent,no", "briefings:3: was not written so"),
                (".briefings", "\n", "\r\n", "briefings:1: was not written so"),
                (".participants", "P2,1", "P2,2", "participants:3: was not written so"),
                (".traces/P1-2.haptic.csv", "P1", "P3", "P1-2.haptic.csv: is not as it was written"),
                (".chain", r"(\n(?:[^,]*,){4})\w\w", r"\g<1>00", ".chain:2: does not follow from the line before"),
                (".chain", r"\n[^\n]*\n", "\n", ".chain:2: does not follow from the line before"),
                (".chain", "time_utc", "time", ".chain:1: is not as it was written"),
                (".chain", r"\n[^\n]*\n", "\nnothing\n", ".chain:2: does not follow from the line before")]:
            with self.subTest(said=said):
                keep = Path(f"{self.path}{name}").read_bytes()
                self.edit(name, old, new)
                self.require(said)
                Path(f"{self.path}{name}").write_bytes(keep)
        self.assertNotIn("EXPLORATORY", self.report())
        for name in ".traces/P9-1.csv", ".traces/P1-2.csv.bak", ".thresholds.bak":
            Path(f"{self.path}{name}").write_text("more")
            self.require(f"{name}: is not in the chain")
            Path(f"{self.path}{name}").unlink()
        for name, said in ((".traces/P1-2.haptic.csv", "P1-2.haptic.csv: is missing"), (".chain", ".chain: is missing")):
            Path(f"{self.path}{name}").unlink()
            self.require(said)

    def test_what_cannot_be_read_any_more_is_named(self):
        for name, old, new in ((".presentations", ",problem,", ",fault,"),
                               (".participants", r"\nP2,[^\n]*", "\nP2"),
                               (".settings.json", '"clips_sha256"', '"clips"')):
            with self.subTest(name=name):
                keep = Path(f"{self.path}{name}").read_bytes()
                self.edit(name, old, new)
                with self.assertRaisesRegex(ValueError, re.escape(name) + r"(:\d)?: (is|was) not .*written"):
                    self.report()
                Path(f"{self.path}{name}").write_bytes(keep)

    def entries(self):
        return list(chain.read(self.path).values())

    @staticmethod
    def linked(entries):
        link, found = chain.COLUMNS[-1], []
        for entry in entries:
            link = chain.hash_of(link, entry["kind"], entry["digest"])
            found.append(entry | {"link": link})
        return found

    def is_caught(self, entries, noted):
        """That a code is not as it was noted, or the chain says what is wrong."""
        with patch.object(chain, "read", lambda _: dict(enumerate(entries, 2))):
            return chain.codes(self.path) != noted or chain.walk(chain.read(self.path))[0] or next(chain.misfits(self.path), None)

    def test_no_entry_can_be_relabelled_inserted_removed_swapped_or_doubled(self):
        """Each with each other, of each kind that a study has: with links as they are, and linked anew, where what is relabelled
        has a digest that fits, too."""
        some = lambda trial, question: 3 if trial.number < 3 and question == "movement" else None
        self.path = study_files.write(self.folder / "one.csv", {"P1": some}, ["a.avi"])
        with chain.session(self.path):
            records.Participants(self.path).register("P2")
            chain.add(self.path, "clip", "P2-1")
            chain.add(self.path, "look", "1")
        records.Participants(self.path).withdraw("P2")
        noted, entries = chain.codes(self.path), self.entries()
        self.assertEqual({entry["kind"] for entry in entries}, {"session", "end", "row", "file", "clip", "look", "withdrawn"})
        self.assertFalse(self.is_caught(self.linked(entries), noted))
        sealed = lambda entry: entry | {"digest": chain.hash_of(entry["salt"], entry["time_utc"], entry["name"], b"")}
        unseen, count = [], 0
        for (i, one), (j, other) in itertools.product(enumerate(entries), repeat=2):
            without = entries[:i] + entries[i + 1:]
            replaced = lambda entry: [*entries[:i], entry, *entries[i + 1:]]
            relabelled = [one | {name: other[name] for name in names} for names in (["kind"], ["kind", "name"], ["time_utc", "salt"])]
            forgeries = [without, [*without[:j], one, *without[j:]], [*entries[:j], one, *entries[j:]], *map(replaced, relabelled)]
            for forged in [*forgeries, *map(self.linked, [*forgeries, *(replaced(sealed(each)) for each in relabelled)])]:
                if forged != entries:
                    count += 1
                    unseen += [] if self.is_caught(forged, noted) else [(i, j, one, other)]
        self.assertEqual(unseen, [])
        self.assertGreater(count, 10 * len(entries)**2)

    def test_nothing_is_written_after_an_end_and_no_settings_after_a_clip(self):
        """By a forger who has the program: each has a code that nobody noted, but without it is named, too."""
        settings = json.loads(Path(f"{self.path}.settings.json").read_text())
        settings["analysis"]["margin_steps"] = 2
        kept = {name: Path(f"{self.path}{name}").read_text() for name in (".chain", ".settings.json")}
        for write, said in ((lambda: chain.write_file(self.path, ".settings.json", json.dumps(settings)), '"file" does not come after "end"'),
                            (lambda: chain.add(self.path, "note"), '"note" does not come after "end"'),
                            (lambda: chain.add_row(self.path, ".briefings", "P3,guess,none"), '"row" does not come after "end"')):
            write()
            self.require(said)
            for name, text in kept.items():
                Path(f"{self.path}{name}").write_text(text)
        self.edit(".briefings", "P3,guess,none\n", "")
        with chain.session(self.path):
            chain.write_file(self.path, ".settings.json", json.dumps(settings))
        self.require('"file .settings.json" has no place here')
        Path(f"{self.path}.chain").write_text(kept[".chain"])
        with chain.session(self.path):
            Path(f"{self.path}.traces/P1-2.csv").write_text("more")
            chain.add_file(self.path, ".traces/P1-2.csv")
        self.require('"file .traces/P1-2.csv" has no place here')

    def test_names_answers_that_belong_to_nothing_that_was_shown_though_the_chain_fits(self):
        """Written by somebody with the program at hand."""
        shown = records.read_answers(self.path)[0]
        self.assertEqual(shown.trial, 1)
        for changed, said in (({"question": "another", "trial": 99}, "trial 99, another: no presentation of it counts"),
                              ({"participant": "P9"}, "P9, trial 1, movement: no presentation of it counts"),
                              ({"question": "another", "condition": "nonlinear" if shown.condition == "linear" else "linear"},
                               "was not what was shown"), ({}, "answered twice")):
            copy = self.folder.with_name(f"copy-{len(said)}")
            shutil.copytree(self.folder, copy)
            with chain.session(copy / "answers.csv"):
                records.append_row(copy / "answers.csv", "", records.COLUMNS, list((vars(shown) | changed).values()))
            with self.assertRaisesRegex(ValueError, said):
                self.report(copy / "answers.csv")

    def test_who_withdraws_leaves_a_chain_that_fits_and_tells_nothing(self):
        codes = chain.codes(self.path)
        records.Participants(self.path).withdraw("P2")
        self.assertNotIn("EXPLORATORY", self.report())
        self.assertIn("withdrew: 1", self.report())
        self.assertEqual(chain.codes(self.path)[:len(codes)], codes)
        chained = Path(f"{self.path}.chain").read_text()
        self.assertNotIn("P2", chained)
        gone = [entry["kind"] for entry in self.entries() if not entry["salt"]]
        # Rows of participants and briefings, presentations with their clips and traces, answers to 4 and 6 of these.
        self.assertEqual({kind: gone.count(kind) for kind in gone}, {"row": 1 + 1 + 11 + 4 + 6 * 3, "clip": 11, "file": 11})
        records.Participants(self.path).withdraw("P1")
        self.assertNotIn("EXPLORATORY", self.report())
        self.edit(".chain", r"(?s)(.*\nrow,)[^,]+,[^,]*,[^,]{5,},", r"\g<1>,,,")
        self.require("is unreadable, and not of who withdrew")
        self.edit("", "P3,1,[^\n]*\n", "")
        self.require("of the rows that were written are not in it")

    def test_a_withdrawal_that_was_interrupted_is_finished_by_the_next_one(self):
        """Before each of the files that it replaces takes the place of the old one."""
        replace, kept = chain.os.replace, self.folder.with_name("kept")
        shutil.copytree(self.folder, kept)
        for count in range(5):
            shutil.rmtree(self.folder)
            shutil.copytree(kept, self.folder)
            left = iter(range(count))

            def killed(old, new, left=left):
                if next(left, None) is None:
                    raise KeyboardInterrupt
                replace(old, new)

            with patch.object(chain.os, "replace", killed), self.assertRaises(KeyboardInterrupt):
                records.Participants(self.path).withdraw("P2")
            records.Participants(self.path).withdraw("P2")
            self.assertIn("withdrew: 1", self.report())
            self.assertFalse([file for file in self.folder.rglob("*") if file.is_file() and "P2" in file.name + file.read_text()])

    def test_a_session_that_the_power_ended_fits(self):
        """Between an entry of the chain and its row, within the row, and within a line of the chain; or in a clip."""
        def killed(*write):
            chain.add(self.path, "session", "lab")
            chain.add(self.path, *write)

        kept = Path(f"{self.path}.briefings").read_text()
        for written in "", "P3,gue":
            killed("row", ".briefings", b"P3,guess,none")
            Path(f"{self.path}.briefings").write_text(kept + written)
            with chain.session(self.path):
                pass
            self.assertNotIn("EXPLORATORY", self.report())
            self.assertEqual(Path(f"{self.path}.briefings").read_text(), kept)
        killed("clip", "P3-99")
        for trace in ".csv", ".haptic.csv":
            Path(f"{self.path}.traces/P3-99{trace}").write_text("tick")
        for _ in range(2):
            self.assertIn("the session was killed in P3-99", self.report())
            with open(f"{self.path}.chain", "a", encoding="utf-8") as file:
                file.write("row,.briefings,1f")
            with chain.session(self.path):
                records.append_row(self.path, ".briefings", [], ["P3", "guess", "none"])
        records.Participants(self.path).withdraw("P3")
        self.assertEqual([name for name in chain.files_there(self.path) if "P3" in name], [])
        self.assertNotIn("P3", Path(f"{self.path}.chain").read_text())

    def test_files_of_several_machines_are_of_different_people(self):
        other = self.study(self.folder / "other.csv", people=("P1", "P2", "P4"), host="lab2")
        text = self.report(self.path, other)
        self.assertNotIn("EXPLORATORY", text)
        self.assertRegex(text, r"(?m)^controllers: movement +linear, nonlinear +6 +2 ")
        self.assertIn("host lab2", text)
        with self.assertRaisesRegex(ValueError, "third.csv: is of the machine lab, as another one is"):
            self.report(self.path, self.study(self.folder / "third.csv", people=("P1", "P5", "P6")))
        with self.assertRaisesRegex(ValueError, "seed was 1, not 2"):
            self.report(self.path, self.study(self.folder / "seed.csv", host="lab3", seed=2))

    def test_a_clip_is_known_by_its_content_on_each_machine(self):
        digests = json.loads(Path(f"{self.path}.settings.json").read_text())["clips_sha256"]
        renamed = {"c.avi": digests["b.avi"], "b.avi": digests["a.avi"]}
        other = self.study(self.folder / "other.csv", clips=["c.avi", "b.avi"], host="lab2", clips_sha256=renamed)
        self.assertEqual({answer.clip for answer in records.read_merged([self.path, other])}, {"a.avi", "b.avi"})
        self.assertRegex(self.report(self.path, other), r"(?m)^controllers: movement +linear, nonlinear +6 +2 ")
        self.edit("", ",c.avi,", ",z.avi,", other)
        with self.assertRaisesRegex(ValueError, "other.csv:[0-9]+: was not written so.*z.avi"):
            self.report(self.path, other)

    def test_a_copy_is_no_other_machine(self):
        """Its host changed, and its chain made anew."""
        copy = self.folder / "copy.csv"
        for name in chain.files_there(self.path) | {*chain.TABLES, ".chain"}:
            if Path(f"{self.path}{name}").exists():
                Path(f"{copy}{name}").parent.mkdir(exist_ok=True)
                shutil.copy(f"{self.path}{name}", f"{copy}{name}")
        self.edit(".settings.json", '"host": "lab"', '"host": "lab2"', copy)
        with self.assertRaisesRegex(ValueError, "copy.csv: has answers of another file, given at the same times"):
            self.report(self.path, copy)
        self.assertIn(f"{copy}.settings.json: is not as it was written", report.misfits([self.path, copy]))

    def test_nobody_writes_into_the_session_of_another_program(self):
        with chain.session(self.path):
            for _ in range(2):
                with self.assertRaisesRegex(ValueError, "another program has a session of this study"), chain.session(self.path):
                    pass
                chain.replace_file(f"{self.path}.chain", Path(f"{self.path}.chain").read_text())  # as forget() does
        self.assertNotIn("EXPLORATORY", self.report())

    def test_files_that_were_put_together_are_refused(self):
        other = self.study(self.folder / "other.csv", people=("P1",), host="lab2")
        with open(self.path, "a", encoding="utf-8") as file:
            file.write("".join(other.read_text().splitlines(True)[1:]))
        self.require("was not written so", "more")


class Looks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "answers.csv")

    def report(self, people, planned):
        """After so many have answered, in a study of so many."""
        source = random.Random(people)
        with contextlib.redirect_stdout(io.StringIO()):
            if not self.path.exists():
                study_files.write(self.path, {}, participants=planned)
            for n in range(sum(1 for _ in records.read_rows(f"{self.path}.participants")), people):
                with chain.session(self.path):
                    study_files.answer(self.path, records.read_settings(self.path), f"P{n}", lambda *_: source.randint(1, 5), ["a.avi", "b.avi"], [])
            return report.report(records.read_answers(self.path), [self.path])

    def test_each_look_is_counted_and_has_its_level(self):
        """By the bounds of Lan and DeMets' function as ldbounds of R has them, z = 2.9626, 1.9686 after half and at the end."""
        for people, said in ((6, "INTERIM, NOT THE TEST: look 1, at 6 of 8 participants: p counts below 0.00305, so that all looks together err in 5 %"),
                             (6, "INTERIM, NOT THE TEST: look 1, at 6 of 8"), (8, "look 2, at 8 of 8 participants: p counts below 0.049,"),
                             (8, "look 2, at 8 of 8"), (9, "AFTER THE TEST: the level was spent when 8 participants were reached")):
            text = self.report(people, 8)
            self.assertIn(said, text.splitlines()[0])
            self.assertEqual("INTERIM" in text, people < 8)
        self.assertEqual(chain.named(self.path, "look"), ["6", "8", "9"])
        self.assertIn("primary (no test)", text)

    def test_an_exploratory_look_is_counted_too(self):
        with contextlib.redirect_stdout(io.StringIO()):
            study_files.write(self.path, {"P0": lambda *_: 3}, participants=8)
            Path(f"{self.path}.more").touch()
            self.assertIn("(no test)", report.report(records.read_answers(self.path), [self.path], exploratory=True))
        self.assertEqual(chain.named(self.path, "look"), ["1"])

    def test_without_a_registration_there_is_no_test(self):
        text = self.report(2, None)
        self.assertTrue(text.startswith("NOT REGISTERED"))
        self.assertIn("primary (no test)", text)
        self.assertNotIn("registered 20", text)


if __name__ == "__main__":
    unittest.main()
