# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""What a participant is shown and asked: conditions, questions, and their order."""

import itertools
import random
from dataclasses import dataclass

STEPS = ["bad", "poor", "average", "good", "very good"]  # the paper's scale, 1 to 5
# The paper's comparisons (Table 1 and Table 2), each with its conditions and its questions. "sham" is the force of
# "with", turned by 180°: as strong and at the same time, but against the motion in the picture.
CONDITIONS = {"controllers": ("linear", "nonlinear"), "haptics": ("without", "sham", "with")}
# Which conditions are compared: whether the second is higher than the first.
PAIRS = {"controllers": [("linear", "nonlinear")], "haptics": [("without", "with"), ("sham", "with")]}
QUESTIONS = {
    "controllers": {"movement": "How well did you feel the movement of the objects in the video?"},
    "haptics": {"reality": "How real did the scene feel?",
                "interactivity": "How much did you feel a part of the scene?",
                "comfort": "How comfortable was it?"},
}
# What is decided before the first participant, and written to the settings. `equal`: questions whose answers are expected
# to be the same, within `margin_steps`. All others but the primary one are secondary.
ANALYSIS = {
    "primary": "movement", "equal": ["comfort"], "margin_steps": 0.5, "level": 0.05,
    "exclusions": [
        "A presentation whose force was not delivered is repeated, and not asked about.",
        "Who has rated less than half of the clips in both conditions is left out of that comparison.",
        "Nobody is left out for their answers; comparisons with the sham are repeated without those who saw through it."]}
# The orders in which the conditions of a clip follow each other: all there are.
ORDERS = {"controllers": [(0, 1), (1, 0)],
          "haptics": [(0, 1, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0), (1, 0, 2), (0, 2, 1)]}
FAMILIES = ("primary", "secondary", "equal")
FIRST_GOOD = 3  # the paper counts "average" as good
BLOCK = 12  # participants: six for each order of the parts, who together have each order of each clip equally often


@dataclass
class Trial:
    """One presentation of one clip. The participant sees `code` instead of the condition."""
    number: int  # from 1 on, in the order of presentation
    part: str
    condition: str
    code: str
    clip: str


def family_of(question, analysis):
    return ("equal" if question in analysis["equal"] else "primary" if question == analysis["primary"] else "secondary")


def analysis_of(primary):
    """ANALYSIS with another primary outcome, which is then not expected to be equal."""
    return ANALYSIS | {"primary": primary, "equal": [name for name in ANALYSIS["equal"] if name != primary]}


def families(analysis):
    """The comparisons of each: (question, first condition, second). A primary question of the study's own is asked after
    each clip, in both parts."""
    found = {family: [] for family in FAMILIES}
    own = {analysis["primary"]} - {name for questions in QUESTIONS.values() for name in questions}
    for part, questions in QUESTIONS.items():
        for question in [*questions, *own]:
            found[family_of(question, analysis)] += [(question, *pair) for pair in PAIRS[part]]
    return found


def shuffled(values, source):
    # Of Python's generator, random() alone promises the same numbers in each version.
    return sorted(values, key=lambda _: source.random())


def schedule(clips, index, seed):
    """All trials of participant `index` (0, 1, …).

    The conditions of a clip follow each other, and clips are in random order. Every other participant begins with the
    second part. In a block of 12, the six of each order of the parts have each order of a clip's conditions equally
    often. Who has which is drawn for each part alone, and differs from clip to clip. The same arguments give the same
    trials on every machine. Raises ValueError if a clip is given twice.
    """
    if len(set(clips)) != len(clips):
        raise ValueError("the same clip is given twice")
    block, place = divmod(index, BLOCK)
    is_swapped, place = place % 2, place // 2
    source = random.Random(f"{seed} {index}")
    # A letter and a digit, or more digits if that many trials need them, without characters that can be confused.
    count = len(clips) * sum(map(len, CONDITIONS.values()))
    codes = next(codes for digits in itertools.count(1) if len(codes := ["".join(code) for code in itertools.product(
        "ACDEFHJKLMNPRTUVWXY", *["2345679"] * digits)]) >= count)
    codes = shuffled(codes, source)
    trials = []
    for part in reversed(CONDITIONS) if is_swapped else CONDITIONS:
        conditions, orders = CONDITIONS[part], ORDERS[part]
        drawn = shuffled(range(BLOCK // 2), random.Random(f"{seed} {block} {part} {is_swapped}"))[place]
        for clip in shuffled(clips, source):
            for n in orders[(drawn + clips.index(clip)) % len(orders)]:
                trials.append(Trial(len(trials) + 1, part, conditions[n], codes[len(trials)], clip))
    return trials


def open_questions(answers, participant, trials, extra):
    """For each trial what is still to be asked. Raises ValueError if the participant has begun with other trials."""
    answered = set()
    for answer in (a for a in answers if a.participant == participant):
        if answer.shown() not in trials:
            raise ValueError(f"{participant} has begun with other trials: {answer.trial} was {answer.clip}, "
                             f"{answer.condition}; give the same clips again, and the files that belong to the answers")
        answered.add((answer.trial, answer.question))
    return [{name: text for name, text in (QUESTIONS[trial.part] | extra).items()
             if (trial.number, name) not in answered} for trial in trials]
