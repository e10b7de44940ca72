# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files of a made study, as `study.py run` leaves them."""

import contextlib
import hashlib
import io
import os
import platform
import secrets
from pathlib import Path
from unittest.mock import patch

import chain
import records
import trials

SETTINGS = {"version": "0.1", "device": "sim", "profile": "", "host": "lab", "seed": 1, "paper": False, "practice": "",
            "analysis": trials.ANALYSIS, "questions": trials.QUESTIONS | {"every clip": {}}}


def write(path, steps, clips=("a.avi", "b.avi"), extra=(), preview=None, **settings):
    """`steps`: by participant, from trial and question to the answer, or None where a question was not answered. Each
    trial has a trace, and in the first one a presentation before it that did not count."""
    digests = {clip: hashlib.sha256(clip.encode()).hexdigest() for clip in clips}
    settings = SETTINGS | {"clips_sha256": digests, "participants": len(steps)} | settings
    with patch.object(platform, "node", lambda: settings["host"]), patch.object(os, "fsync"), \
            contextlib.redirect_stdout(io.StringIO()):
        with chain.session(path):
            records.write_settings(path, settings, preview or {})
        Path(f"{path}.traces").mkdir()
        for who, step_of in steps.items():
            with chain.session(path):
                answer(path, settings, who, step_of, clips, extra)
    return path


def answer(path, settings, who, step_of, clips, extra):
    participants = records.Participants(path)
    records.append_row(path, ".briefings", ["participant", "check", "answer"], [who, "consent", "yes"])
    shown = trials.schedule(list(clips), participants.index_of(who), settings["seed"])
    participants.register(who)
    for trial in shown:
        names = [f"{who}-{trial.number}", *[f"{who}-1-2"] * (trial.number == 1)]
        for name in names:
            chain.add(path, "clip", name)
            Path(f"{path}.traces/{name}.haptic.csv").write_text(f"tick\n{name}\n{secrets.token_hex(8)}\n")
            chain.add_file(path, f".traces/{name}.haptic.csv")
            records.append_row(path, ".presentations", records.PRESENTATION_COLUMNS,
                               [who, trial.number, name, "0.99", "weak" if name != names[-1] else "", "now"])
        for question in [*trials.QUESTIONS[trial.part], *extra]:
            if step := step_of(trial, question):
                records.append_row(path, "", records.COLUMNS, [who, trial.number, trial.part, trial.condition, trial.code,
                                                               trial.clip, question, step, "now"])
