# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What a participant is shown and asked, and the file of the answers."""

import csv
import os
import random
from dataclasses import dataclass, fields
from datetime import datetime, timezone
from pathlib import Path

STEPS = ["bad", "poor", "average", "good", "very good"]  # the paper's scale, 1 to 5
# The paper's comparisons (Table 1 and Table 2), each with its two conditions and its questions.
CONDITIONS = {"controllers": ("linear", "nonlinear"), "haptics": ("without", "with")}
QUESTIONS = {
    "controllers": {"movement": "How well did you feel the movement of the objects in the video?"},
    "haptics": {"reality": "How real did the scene feel?",
                "interactivity": "How much did you feel a part of the scene?",
                "comfort": "How comfortable was it?"},
}


@dataclass
class Trial:
    """One presentation of one clip. The participant sees `code` instead of the condition."""
    number: int  # from 1 on, in the order of presentation
    part: str
    condition: str
    code: str
    clip: str


@dataclass
class Answer:
    """A row of the file, whose columns have these names."""
    participant: str
    trial: int
    part: str
    condition: str
    code: str
    clip: str
    question: str
    answer: int
    time_utc: str


COLUMNS = [field.name for field in fields(Answer)]


def shuffled(values, source):
    # Of Python's generator, random() alone promises the same numbers in each version.
    return sorted(values, key=lambda _: source.random())


def schedule(clips, index, seed):
    """All trials of participant `index` (0, 1, … in order of arrival).

    The two conditions of a clip follow each other, and the paper's first comparison comes first. Clips are in random
    order. The condition that comes first alternates from clip to clip and is reversed for the next participant, so that
    after an even number of participants both orders are balanced for each clip. The same arguments give the same trials
    on every machine. Raises ValueError if a clip is given twice.
    """
    if len(set(clips)) != len(clips):
        raise ValueError("the same clip is given twice")
    source = random.Random(f"{seed} {index}")
    # A letter and a digit, without characters that can be confused.
    codes = shuffled([letter + digit for letter in "ACDEFHJKLMNPRTUVWXY" for digit in "2345679"], source)
    trials = []
    for part, conditions in CONDITIONS.items():
        for clip in shuffled(clips, source):
            is_reversed = (clips.index(clip) + index) % 2 == 1
            for condition in reversed(conditions) if is_reversed else conditions:
                code = codes[len(trials) % len(codes)]
                trials.append(Trial(len(trials) + 1, part, condition, code, clip))
    return trials


def utc_now():
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def append_row(path, header, row):
    """Appends a line, after the header in a new file, and flushes it to the disk."""
    with open(path, "a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if file.tell() == 0:
            writer.writerow(header)
        writer.writerow(row)
        file.flush()
        os.fsync(file.fileno())


def parse_answer(row):
    if len(row) != len(COLUMNS):
        raise ValueError(f"{len(row)} columns, not {len(COLUMNS)}")
    answer = Answer(*row)
    if answer.condition not in CONDITIONS.get(answer.part, ()):
        raise ValueError(f'"{answer.part}, {answer.condition}" is no part with one of its conditions')
    if answer.answer not in ("1", "2", "3", "4", "5"):
        raise ValueError(f'"{answer.answer}" is no number from 1 to {len(STEPS)}')
    if not answer.trial.isdigit():
        raise ValueError(f'"{answer.trial}" is no number of a trial')
    answer.trial, answer.answer = int(answer.trial), int(answer.answer)
    return answer


def read_answers(path):
    """A missing file has no answers. Raises ValueError that names file, line and what is wrong."""
    if not Path(path).exists():
        return []
    answers = []
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        if next(reader, COLUMNS) != COLUMNS:
            raise ValueError(f"{path}:1: not a file of answers, which begins with {','.join(COLUMNS)}")
        for row in reader:
            try:
                answers.append(parse_answer(row))
            except ValueError as error:
                raise ValueError(f"{path}:{reader.line_num}: {error}") from error
    return answers


def index_of(answers, participant):
    """Position of the participant in the order of first answers; a new one comes last."""
    seen = list(dict.fromkeys(answer.participant for answer in answers))
    return seen.index(participant) if participant in seen else len(seen)


def open_questions(answers, participant, trials, extra):
    """For each trial what is still to be asked. Raises ValueError if the participant has begun with other trials."""
    answered = set()
    for answer in (a for a in answers if a.participant == participant):
        given = Trial(answer.trial, answer.part, answer.condition, answer.code, answer.clip)
        if given not in trials:
            raise ValueError(f"{participant} has begun with other clips or another seed: trial {answer.trial} was "
                             f"{answer.clip}, {answer.condition}; give the same again")
        answered.add((answer.trial, answer.question))
    return [{name: text for name, text in (QUESTIONS[trial.part] | extra).items()
             if (trial.number, name) not in answered} for trial in trials]
