# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files of a made study, as `study.py run` leaves them."""

from pathlib import Path

import chain
import records
import trials

SETTINGS = {"version": "0.1", "device": "sim", "profile": "", "host": "lab", "seed": 1, "paper": False, "practice": "",
            "analysis": trials.ANALYSIS, "questions": trials.QUESTIONS | {"every clip": {}}}


def write(path, steps, clips=("a.avi", "b.avi"), extra=(), preview=None, **settings):
    """`steps`: by participant, from trial and question to the answer, or None where a question was not answered. Each
    trial has a trace, and in the first one a presentation before it that did not count."""
    settings = SETTINGS | {"clips_sha256": dict.fromkeys(clips, "1f")} | settings
    chain.begin(path, settings["host"])
    records.write_settings(path, settings, preview or {})
    chain.end(path)
    Path(f"{path}.traces").mkdir()
    for who, step_of in steps.items():
        chain.begin(path, settings["host"])
        participants = records.Participants(path)
        records.append_row(path, ".briefings", ["participant", "check", "answer"], [who, "consent", "yes"])
        shown = trials.schedule(list(clips), participants.index_of(who), settings["seed"])
        participants.register(who)
        for trial in shown:
            names = [f"{who}-{trial.number}", *[f"{who}-1-2"] * (trial.number == 1)]
            for name in names:
                Path(f"{path}.traces/{name}.haptic.csv").write_text(f"tick\n{name}\n")
                chain.add_file(path, f".traces/{name}.haptic.csv")
                records.append_row(path, ".presentations", records.PRESENTATION_COLUMNS,
                                   [who, trial.number, name, "0.99", "weak" if name != names[-1] else "", "now"])
            for question in [*trials.QUESTIONS[trial.part], *extra]:
                if step := step_of(trial, question):
                    records.append_row(path, "", records.COLUMNS, [who, trial.number, trial.part, trial.condition, trial.code,
                                                                   trial.clip, question, step, "now"])
        chain.end(path)
    return path
