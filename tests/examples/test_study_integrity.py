#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether the study's report names what was changed after it was written, and files of several machines.

    test_study_integrity.py FOLDER-OF-STUDY.PY
"""

import json
import random
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import chain  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402
import study_files  # noqa: E402


class Integrity(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.path = self.study("answers.csv")

    def study(self, name, people=("P1", "P2", "P3"), **settings):
        source = random.Random(name)
        return study_files.write(self.folder / name, dict.fromkeys(people, lambda *_: source.randint(1, 5)), **settings)

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
        for each in said:
            self.assertIn(each, str(caught.exception))
            self.assertIn(each, marked)

    def test_files_as_they_were_written_fit(self):
        text = self.report()
        self.assertNotIn("EXPLORATORY", text)
        ends = chain.ends(self.path)
        self.assertEqual(len(ends), 4, "the settings, and each participant")
        self.assertIn(f"sessions end with {', '.join(ends)}", text)
        last = self.path.with_name("answers.csv.chain").read_text().splitlines()[-1]
        self.assertTrue(last.split(",")[-1].startswith(ends[-1]))
        records.Participants(self.path).withdraw("P2")
        self.assertEqual(chain.ends(self.path), ends, "what was noted stays")

    def test_names_what_was_changed(self):
        for name, old, new, said in [
                (".settings.json", '"seed": 1', '"seed": 2', "settings.json: is not as it was written"),
                (".preview.json", "{}", '{"a": 0}', "preview.json: is not as it was written"),
                ("", r"\b(non)?linear\b", lambda found: "linear" if found[1] else "nonlinear", "was not what was shown"),
                ("", r"(,[1-5]),now", r"\g<1>,then", "answers.csv:2: was not written so: P1,"),
                (".presentations", "weak", "", "presentations:2: was not written so: P1,1,P1-1,"),
                (".presentations", r"P1,2,[^\n]*\n", "", "1 of the rows that were written are not in it"),
                (".presentations", "trial,trace", "trace,trial", "presentations:1: was not written so"),
                (".briefings", "P2,consent,yes", "P2,consent,no", "briefings:3: was not written so"),
                (".participants", "P2,1", "P2,2", "participants:3: was not written so"),
                (".traces/P1-2.haptic.csv", "P1", "P3", "P1-2.haptic.csv: is not as it was written"),
                (".chain", r"(\n[^,]*,[^,]*,)\w\w", r"\g<1>00", ".chain:2: does not follow from the line before"),
                (".chain", r"\n[^\n]*\n", "\n", ".chain:2: does not follow from the line before")]:
            with self.subTest(said=said):
                keep = Path(f"{self.path}{name}").read_text()
                self.edit(name, old, new)
                self.require(said)
                Path(f"{self.path}{name}").write_text(keep)
        self.assertNotIn("EXPLORATORY", self.report())
        for name, said in ((".traces/P1-2.haptic.csv", "P1-2.haptic.csv: is missing"), (".chain", ".chain: is missing")):
            Path(f"{self.path}{name}").unlink()
            self.require(said)

    def test_names_answers_that_belong_to_nothing_that_was_shown_though_the_chain_fits(self):
        """Written by somebody with the program at hand."""
        shown = records.read_answers(self.path)[0]
        self.assertEqual(shown.trial, 1)
        for changed, said in (({"question": "another", "trial": 99}, "trial 99, another: no presentation of it counts"),
                              ({"participant": "P9"}, "P9, trial 1, movement: no presentation of it counts"),
                              ({"question": "another", "condition": "nonlinear" if shown.condition == "linear" else "linear"},
                               "was not what was shown"), ({}, "answered twice")):
            path = self.folder / f"copy-{len(said)}.csv"
            for name in (*chain.TABLES, *chain.FILES, ".chain"):
                if Path(f"{self.path}{name}").exists():
                    shutil.copy(f"{self.path}{name}", f"{path}{name}")
            shutil.copytree(f"{self.path}.traces", f"{path}.traces")
            records.append_row(path, "", records.COLUMNS, list((vars(shown) | changed).values()))
            with self.assertRaisesRegex(ValueError, said):
                self.report(path)

    def test_who_withdraws_leaves_a_chain_that_fits_and_tells_nothing(self):
        records.Participants(self.path).withdraw("P2")
        self.assertNotIn("EXPLORATORY", self.report())
        self.assertIn("withdrew: 1", self.report())
        chained = Path(f"{self.path}.chain").read_text()
        self.assertNotIn("P2", chained)
        gone = [row["file"] for row in chain.read(self.path) if not row["salt"]]
        # Rows of participants and briefings, presentations and their traces, answers to 4 and 6 of these.
        self.assertEqual(gone, ["withdrawn 1"] * (1 + 1 + 11 + 11 + 4 + 6 * 3))
        records.Participants(self.path).withdraw("P1")
        self.assertNotIn("EXPLORATORY", self.report())
        self.edit(".chain", "\n,[^,]{5,}", "\nwithdrawn 3,")
        self.require("entries are unreadable that are not of who withdrew")
        self.edit(".chain", "\nwithdrawn 3", "\nwithdrawn 2")
        self.require("entries are unreadable that are not of who withdrew")
        self.edit("", "P3,1,[^\n]*\n", "")
        self.require("1 of the rows that were written are not in it")

    def test_a_session_that_the_power_ended_fits(self):
        """Between an entry of the chain and its row, within the row, and within a line of the chain."""
        kept = Path(f"{self.path}.briefings").read_text()
        for written in "", "P3,gue":
            records.append_row(self.path, ".briefings", ["participant", "check", "answer"], ["P3", "guess", "none"])
            Path(f"{self.path}.briefings").write_text(kept + written)
            chain.begin(self.path, "lab")
            self.assertNotIn("EXPLORATORY", self.report())
            self.assertEqual(Path(f"{self.path}.briefings").read_text(), kept)
        with open(f"{self.path}.chain", "a", encoding="utf-8") as file:
            file.write(".briefings,1f")
        records.append_row(self.path, ".briefings", ["participant", "check", "answer"], ["P3", "guess", "none"])
        self.assertNotIn("EXPLORATORY", self.report())

    def test_files_of_several_machines_are_of_different_people(self):
        other = self.study("other.csv", people=("P1", "P2"), host="lab2")
        text = self.report(self.path, other)
        self.assertNotIn("EXPLORATORY", text)
        self.assertRegex(text, r"(?m)^controllers: movement +linear, nonlinear +5 +2 ")
        self.assertIn("host lab2", text)
        with self.assertRaisesRegex(ValueError, "other.csv: is of the machine lab, as another one is"):
            self.report(self.path, self.study("third/other.csv".replace("third/", "third-"), people=("P1",)))
        with self.assertRaisesRegex(ValueError, "seed was 1, not 2"):
            self.report(self.path, self.study("seed.csv", people=("P1",), host="lab3", seed=2))

    def test_files_that_were_put_together_are_refused(self):
        other = self.study("other.csv", people=("P1",), host="lab2")
        with open(self.path, "a", encoding="utf-8") as file:
            file.write("".join(other.read_text().splitlines(True)[1:]))
        self.require("was not written so", "more")


if __name__ == "__main__":
    unittest.main()
