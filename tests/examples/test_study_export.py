#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A study as a folder for other programs, and what R makes of it.

    test_study_export.py FOLDER-OF-STUDY.PY
"""

import contextlib
import csv
import gzip
import io
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import numpy as np  # noqa: E402
from scipy.stats import t  # noqa: E402

import export  # noqa: E402
import inference  # noqa: E402
import plan  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402

PEOPLE, CLIPS = 24, 6
R_PACKAGES = "ordinal", "lmerTest"
# What BIDS allows beside the files of participants, and of these (its schema's rules for behavioural recordings).
TOP = re.compile(r"dataset_description\.json|README|participants\.(tsv|json)|code/.+|task-[A-Za-z0-9]+_(beh|events|physio)\.json")
OWN = re.compile(r"(sub-[A-Za-z0-9]+)/beh/\1_task-[A-Za-z0-9]+(_run-\d+_(events\.tsv|physio\.tsv\.gz)|_beh\.tsv)")


def has_r():
    if not shutil.which("Rscript"):
        return False
    library = "; ".join(f"library({name})" for name in R_PACKAGES)
    return subprocess.run(["Rscript", "-e", library], capture_output=True, check=False).returncode == 0


class Export(unittest.TestCase):
    """24 people and 6 clips, whose answers have an odds ratio of 5; and what a hand got in one presentation."""
    ODDS_RATIO = 5

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.answers, cls.out = Path(folder.name, "answers.csv"), Path(folder.name, "bids")
        cls.steps = plan.made_answers(np.random.default_rng(5), PEOPLE, CLIPS, math.log(cls.ODDS_RATIO), 1, 0.8)
        with open(cls.answers, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(records.COLUMNS)
            for person, clip, side in np.ndindex(cls.steps.shape):
                writer.writerow([f"P-{person}", 2 * clip + side + 1, "controllers", ("linear", "nonlinear")[side], "A2",
                                 f"/films/{clip}.avi", "movement", cls.steps[person, clip, side], "2026-01-01T00:00:00Z"])
        settings = {"version": "0.1", "device": "sim", "profile": "", "seed": 1, "practice": "", "clips_sha256": {}, "preview": {},
                    "questions": {"controllers": {"movement": "How well?"}}}
        Path(f"{cls.answers}.settings.json").write_text(json.dumps(settings))
        Path(f"{cls.answers}.briefings").write_text("participant,check,answer\nP-1,handedness,both\nP-1,guess,something private\n")
        Path(f"{cls.answers}.thresholds").write_text("participant,felt_N,weber,turned_deg,late_ms\nP-1,0.05,,,\n")
        Path(f"{cls.answers}.presentations").write_text(
            "participant,trial,trace,delivered_fraction,problem\nP-1,0,P-1-0,1,\nP-1,1,P-1-1,0.5,weak\nP-1,1,P-1-1-2,0.98,\n")
        traces = Path(f"{cls.answers}.traces")
        traces.mkdir()
        for name in "P-1-0", "P-1-1", "P-1-1-2":
            columns = ["playing", "monotonic_ns", "running_ns", *(f"{each}_N" for each in export.PHYSIO if "force" in each),
                       *(f"{each}_m" for each in export.PHYSIO if "position" in each)]
            # 700 ticks, of which the 300th is 5 ms late; the clip ends after 600 ms.
            ticks = [[int(n < 600), 10**9 + 10**6 * n + 5 * 10**6 * (n >= 300), 10**6 * n, n, *[0] * 8] for n in range(700)]
            (traces / f"{name}.haptic.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in [columns, *ticks]))
        with contextlib.redirect_stdout(io.StringIO()):
            export.export(cls.answers, cls.out)

    def table(self, name):
        with open(self.out / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    def test_has_the_names_that_bids_allows(self):
        names = [str(file.relative_to(self.out)) for file in self.out.rglob("*") if file.is_file()]
        for name in names:
            self.assertTrue(TOP.fullmatch(name) or OWN.fullmatch(name), name)
        self.assertEqual(sum(name.endswith("_beh.tsv") for name in names), PEOPLE)
        self.assertEqual([name for name in names if "_physio.tsv" in name],
                         ["sub-P1/beh/sub-P1_task-controllers_run-1_physio.tsv.gz"], "neither practice nor what did not count")
        for task in self.out.glob("task-*.json"):
            of, kind = task.stem.rsplit("_", 1)
            self.assertTrue(next(self.out.glob(f"sub-*/beh/*_{of}_*{kind}.tsv*"), None), f"{task}: describes nothing")
        described = json.loads((self.out / "dataset_description.json").read_text())
        self.assertTrue({"Name", "BIDSVersion"} <= described.keys())

    def test_says_what_was_changed(self):
        self.assertRegex((self.out / "README").read_text(), "changed after they were written: `study.py report` names them")

    def test_each_column_is_described_and_nothing_private_is_in_it(self):
        for table, described in (("participants.tsv", "participants.json"),
                                 ("sub-P1/beh/sub-P1_task-controllers_beh.tsv", "task-controllers_beh.json"),
                                 ("sub-P1/beh/sub-P1_task-controllers_run-1_events.tsv", "task-controllers_events.json")):
            columns = self.table(table)[0].keys()
            self.assertLessEqual(columns, json.loads((self.out / described).read_text()).keys())
        people = {row["participant_id"]: row for row in self.table("participants.tsv")}
        self.assertEqual((people["sub-P1"]["handedness"], people["sub-P1"]["felt_N"], people["sub-P2"]["felt_N"]),
                         ("ambidextrous", "0.05", "n/a"))
        for file in self.out.rglob("*.tsv"):
            self.assertNotRegex(file.read_text(), "private|/films")

    def test_recordings_have_a_row_for_each_millisecond(self):
        described = json.loads((self.out / "task-controllers_physio.json").read_text())
        self.assertEqual((described["SamplingFrequency"], described["StartTime"]), (1000, 0))
        for name in described["Columns"]:
            self.assertIn(described[name]["Units"], ("s", "N", "m"))
        with gzip.open(self.out / "sub-P1/beh/sub-P1_task-controllers_run-1_physio.tsv.gz", "rt") as file:
            rows = [line.split("\t") for line in file]
        self.assertEqual({len(row) for row in rows}, {len(described["Columns"])})
        # 600 ticks and five milliseconds in which there was none: the tick before them stands for these.
        self.assertEqual([round(1000 * float(row[0])) for row in rows], [*range(300), *[299] * 5, *range(300, 600)])
        event, = self.table("sub-P1/beh/sub-P1_task-controllers_run-1_events.tsv")
        self.assertEqual((event["onset"], event["duration"], event["trial_type"]), ("0", "0.605", "linear"))

    def test_refuses_what_bids_cannot_tell_apart_and_what_is_there(self):
        with self.assertRaisesRegex(ValueError, "bids: exists; name a new folder"):
            export.export(self.answers, self.out)
        with self.assertRaisesRegex(ValueError, "there is no folder .*/none"):
            export.export(self.answers, self.out.parent / "none" / "bids")
        with self.assertRaisesRegex(ValueError, "not told apart by their letters and digits.*P 1, P1"):
            export.labels_of(["P1", "P 1"])

    def test_says_what_it_still_has_of_whom(self):
        copy = Path(f"{self.answers}.2")
        records.append_row(copy, ".exports", export.EXPORT_COLUMNS, [self.out, "2026-01-01T00:00:00Z"])
        records.append_row(copy, ".exports", export.EXPORT_COLUMNS, ["/no/folder", "2026-01-02T00:00:00Z"])
        still, gone = export.exports_with(copy, "P-1")
        self.assertIn(f"{self.out} still has what was exported of P-1: remove it", still)
        self.assertIn("/no/folder on 2026-01-02T00:00:00Z has been moved or removed", gone)
        self.assertEqual(len(list(export.exports_with(copy, "P-99"))), 1, "who is not in the folder")
        made, = export.exports_with(self.answers, "P-1")
        self.assertEqual(made, still, "an export is noted")

    def test_the_models_of_r_find_what_the_report_finds(self):
        if not has_r():
            print("skipped: R's packages ordinal and lmerTest are not installed (r-cran-ordinal, r-cran-lmertest)")
            self.skipTest("no R")
        done = subprocess.run(["Rscript", self.out / "code/models.R", self.out], capture_output=True, text=True, check=True)
        found, = csv.DictReader(done.stdout.splitlines(), delimiter="\t")
        with patch.object(inference, "MANY_CLIPS", CLIPS):
            own = inference.difference(self.steps[..., 1] - self.steps[..., 0].astype(float))
        self.assertEqual((found["people"], found["clips"]), (str(PEOPLE), str(CLIPS)))
        # Everybody has rated everything: the estimate of a linear mixed model is the mean.
        self.assertAlmostEqual(float(found["steps"]), own.mean, 3)
        # Its variance is that of the quasi-F, but that R takes what neither person nor clip explains from levels and
        # differences together: 5 % of it, which few degrees of freedom determine. An R from the normal distribution would
        # have an interval narrower by a fifth.
        half = (float(found["steps_high"]) - float(found["steps_low"])) / 2
        self.assertAlmostEqual(half / (t.ppf(0.975, float(found["df"])) * own.error), 1, delta=0.05)
        self.assertAlmostEqual(float(found["df"]) / own.freedom, 1, delta=0.2)
        self.assertAlmostEqual(float(found["steps_p"]) / own.p(), 1, delta=0.2)
        self.assertEqual(found["note"], "")
        low, ratio, high = (float(found[name]) for name in ("low", "odds_ratio", "high"))
        self.assertTrue(low < ratio < high and low < self.ODDS_RATIO < high, found)
        self.assertLess(float(found["p"]), 0.05)

    def test_the_models_of_r_say_what_the_answers_do_not_determine(self):
        """Of one clip, two answers of each person: by figures that are not there, and a note."""
        if not has_r():
            self.skipTest("no R")
        with tempfile.TemporaryDirectory() as folder:
            for person in range(6):
                beh = Path(folder, f"sub-{person}", "beh")
                beh.mkdir(parents=True)
                rows = [f"{condition}\ta.avi\tmovement\t{step}\n" for condition, step in (("linear", 1), ("nonlinear", 4 + person % 2))]
                Path(beh, f"sub-{person}_task-controllers_beh.tsv").write_text(
                    "condition\tclip\tquestion\tresponse\n" + "".join(rows))
            done = subprocess.run(["Rscript", self.out / "code/models.R", folder], capture_output=True, text=True, check=True)
        found, = csv.DictReader(done.stdout.splitlines(), delimiter="\t")
        self.assertEqual((found["odds_ratio"], found["p"], found["steps"]), ("NA",) * 3)
        self.assertEqual(found["note"], "odds ratio not determined; difference not determined")


class PaperFigures(unittest.TestCase):
    def test_the_report_counts_one_answer_of_each_person_as_the_paper_does(self):
        """Medians of three clips of three people: 2, 4 and 3, so that two of three are satisfied."""
        steps = [(1, 2, 5), (4, 4, 1), (3, 5, 2)]
        answers = [records.Answer(f"P{person}", clip, "controllers", condition, "A2", f"{clip}.avi", "movement", step, "")
                   for person, own in enumerate(steps) for clip, step in enumerate(own) for condition in ("linear", "nonlinear")]
        lines = report.report(answers).splitlines()
        people = lines[lines.index(next(line for line in lines if line.startswith("As the paper counts"))) + 2]
        self.assertEqual(people.split(), "controllers: movement linear 3 0 1 1 1 0 67 3.00".split())


if __name__ == "__main__":
    unittest.main()
