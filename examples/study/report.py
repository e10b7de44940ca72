# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Shares and means of the answers, and whether they differ, as it was decided before the first participant."""

import math
import statistics
from collections import Counter, defaultdict
from dataclasses import replace

import chain
from briefing import BELIEFS, RIGHT_BELIEF
from inference import MANY_CLIPS, difference, holm, levels
from perception import THRESHOLDS, told_apart
from records import names_of, read_answers, read_rows, read_settings, unfit
from trials import ANALYSIS, CONDITIONS, FAMILIES, FIRST_GOOD, PAIRS, family_of

MOST_NAMED = 10
COLUMNS = "question                   conditions             people  clips  difference (95 %)            p       Holm"


def ratings(answers):
    """Steps by (part, question, condition), in the order in which questions appear, the first condition first."""
    steps = defaultdict(list)
    for answer in answers:
        steps[answer.part, answer.question, answer.condition].append(answer.answer)
    questions = dict.fromkeys((answer.part, answer.question) for answer in answers)
    return {(part, question, condition): steps[part, question, condition] for part, question in questions
            for condition in CONDITIONS[part] if (part, question, condition) in steps}


def of_people(answers):
    """One answer of each participant to each question and condition: the median of all clips, the lower one of two."""
    given = defaultdict(list)
    for answer in answers:
        given[answer.part, answer.question, answer.condition, answer.participant].append(answer)
    return [replace(each[0], answer=statistics.median_low(answer.answer for answer in each)) for each in given.values()]


def distribution(steps_of, what):
    """How often each step was given: the paper's figures 11 to 13, and its tables."""
    lines = [f"question                   condition   {what:7}   bad  poor   avg  good very   good %  mean"]
    for (part, question, condition), steps in steps_of.items():
        counts = [steps.count(step) for step in range(1, 6)]
        good = 100 * sum(counts[FIRST_GOOD - 1:]) / len(steps)
        lines.append(f"{part + ': ' + question:26} {condition:11} {len(steps):7} " +
                     " ".join(f"{count:{5 if step < 4 else 4}}" for step, count in enumerate(counts)) +
                     f"   {good:6.0f}  {sum(steps) / len(steps):4.2f}")
    return lines


def differences(answers):
    """By (part, question, first condition, second): how much higher the second one is, a row for each participant who
    has rated at least half of the clips in both, a column for each clip; NaN where an answer is missing."""
    given = defaultdict(dict)
    for answer in answers:
        given[answer.part, answer.question, answer.participant][answer.clip, answer.condition] = answer.answer
    rows = defaultdict(list)
    for (part, question, _), steps in given.items():
        clips = sorted({answer.clip for answer in answers if (answer.part, answer.question) == (part, question)})
        for first, second in PAIRS[part]:
            row = [steps.get((clip, second), math.nan) - steps.get((clip, first), math.nan) for clip in clips]
            if sum(map(math.isnan, row)) <= len(clips) / 2:
                rows[part, question, first, second].append(row)
    order = {part: place for place, part in enumerate(PAIRS)}
    return dict(sorted(rows.items(), key=lambda item: order[item[0][0]]))


def compared(rows, analysis, family):
    """A line for each comparison of a family."""
    chosen = {key: difference(each) for key, each in rows.items() if family_of(key[1], analysis) == family}
    p = [each.p_of_equivalence(analysis["margin_steps"]) if family == "equal" else each.p() for each in chosen.values()]
    for ((part, question, first, second), each), alone, corrected in zip(chosen.items(), p, holm(p)):
        people, clips = len(rows[part, question, first, second]), len(rows[part, question, first, second][0])
        interval = "not determined" if not each.error > 0 else "{:.2f} to {:.2f}".format(*each.interval())
        yield (f"{part + ': ' + question:26} {first + ', ' + second:22} {people:6} {clips:6}  "
               f"{f'{each.mean:+.2f} ({interval})':24} {alone:8.3g}  {corrected:9.3g}")


def rows_of(paths, table):
    return [row | {"participant": code(row["participant"])} for path, code, _ in names_of(paths)
            for row in read_rows(f"{path}{table}")]


def describe_study(paths):
    """What the answers were made with, and what became of participants and presentations."""
    lines = []
    for path in paths:
        settings = read_settings(path)
        lines.append(", ".join(f"{name} {settings[name]}" for name in ("version", "device", "profile", "host", "seed")
                               if settings[name] != "") + (", the paper's setting" if settings["paper"] else "")
                     + "; registered {} with {}".format(*chain.registered(path)) * bool(settings["participants"])
                     + f"; sessions end with {', '.join(chain.codes(path))}")
        if killed := chain.walk(chain.read(path))[1]:
            lines.append(f"the session was killed in {', '.join(sorted(killed))}")
    shown = rows_of(paths, ".presentations")
    failed = Counter(row["problem"] for row in shown if row["problem"])
    if shown:
        lines.append(f"{len(shown)} presentations, {sum(failed.values())} of which do not count"
                     + "".join(f"; {count}: {problem}" for problem, count in failed.items()))
    withdrew = sum(len(chain.named(path, "withdrawn")) for path in paths)
    if withdrew:
        lines.append(f"withdrew: {withdrew}")
    return lines + [""] * bool(lines)


def describe_thresholds(paths):
    """What people tell at least, and in how many frames the controllers differ for them."""
    rows = rows_of(paths, ".thresholds")
    known = {name: [float(row[name]) for row in rows if row.get(name)] for name in THRESHOLDS}
    median = {name: statistics.median(values) for name, values in known.items() if values}
    if not median:
        return []
    words = {"felt_N": "force {:.3f} N", "weber": "change of it {:.0%}", "turned_deg": "turn {:.0f}°",
             "late_ms": "delay {:.0f} ms"}
    lines = ["", "what people tell on this device at least, medians: " + ", ".join(
        f"{words[name].format(value)} ({len(known[name])} people)" for name, value in median.items())]
    if "felt_N" in median and "weber" in median:
        lines.append("with these, linear and nonlinear differ in")
        for name, clip in read_settings(paths[0], "preview").items():
            amounts = [[math.hypot(*row[1:4]) for row in clip["frames"][force]] for force in ("linear", "nonlinear")]
            apart = told_apart(list(zip(*amounts)), median["felt_N"], median["weber"])[2]
            lines.append(f"{100 * apart:6.0f} % of the felt frames of {name}")
    return lines


def describe_blinding(paths):
    """How many saw through the sham, beyond who guesses: 1 is everybody, 0 is by chance."""
    guesses = [row["answer"] for row in rows_of(paths, ".briefings") if row["check"] == "believed"]
    if not guesses:
        return []
    score = {RIGHT_BELIEF: 1, BELIEFS[-1]: 0}  # of the wrong ones, each is as likely for who guesses
    index = statistics.fmean(score.get(guess, -1 / (len(BELIEFS) - 2)) for guess in guesses)
    return ["", f"blinding index {index:+.2f} of {len(guesses)} people (1: all know of the sham, 0: as by guessing)"]


def misfits(paths):
    """What is not as it was written, in sentences; of a long list, the begin. Of a file that was changed, the rows are
    not read."""
    found = [each for path in paths
             for each in [*chain.misfits(path)] or unfit(read_answers(path), path, read_settings(path))]
    return found[:MOST_NAMED] + [f"… and {len(found) - MOST_NAMED} more"] * (len(found) > MOST_NAMED)


def look(paths, people, level):
    """Counts a look at the answers of so many people in the chains. Returns its level, None if there is none, and a
    line that says why."""
    planned = read_settings(paths[0])["participants"]
    looks = {int(name) for path in paths for name in chain.named(path, "look") if name.isdecimal()}
    if not planned:
        return None, ("NOT REGISTERED: no number of participants was fixed before the first answer, so no p is that "
                      "of a test")
    if people > max(looks, default=0):
        looks.add(people)
        for path in paths:
            with chain.session(path):
                chain.add(path, "look", str(people))
    looks = sorted(looks)
    if looks[-2:-1] >= [planned]:
        return None, (f"AFTER THE TEST: the level was spent when {planned} participants were reached, so no p is "
                      "that of a test")
    found = levels(looks, planned, level)[-1]
    return found, ("INTERIM, NOT THE TEST: " if looks[-1] < planned else "") + (
        f"look {len(looks)}, at {looks[-1]} of {planned} participants: p counts below {found:.3g}, so that all looks "
        f"together err in {100 * level:g} %")


def report(answers, paths=(), exploratory=False):
    """`paths`: the files of these answers. Raises ValueError that names what is not as it was written, unless it is
    exploratory."""
    wrong = misfits(paths)
    if wrong and not exploratory:
        raise ValueError("\n".join(["files are not as they were written; put them back, or say --exploratory, and "
                                    "that it is, wherever you publish it", *wrong]))
    analysis = read_settings(paths[0])["analysis"] if paths else ANALYSIS
    rows, level = differences(answers), analysis["level"]
    lines = ["EXPLORATORY: files are not as they were written", *wrong, ""] if wrong else []
    people = max((len(found) for key, found in rows.items() if family_of(key[1], analysis) == "primary"), default=0)
    if paths and people and all(map(chain.read, paths)):  # a look is one, whatever else is wrong
        found, said = look(paths, people, level)
        if not wrong:
            level, lines = found, [said, ""]
    lines += describe_study(paths)
    lines += distribution(ratings(answers), "answers")
    lines += ["", "As the paper counts, one answer of each person and condition (here the median over the clips):",
              *distribution(ratings(of_people(answers)), "people")]
    margin = analysis["margin_steps"]
    clips = min((len(each[0]) for each in rows.values()), default=MANY_CLIPS)
    inferred = ("clips like these, if no few of them carry most of it" if clips >= MANY_CLIPS else
                f"these clips; of others, fewer than {MANY_CLIPS} say too little")
    lines += ["", "good: average and better, as the paper counts. difference: how many steps the second condition is "
              f"higher, for\nother people and {inferred}. p: of no difference; of\nwhat is expected to be equal, of a "
              f"difference of {margin:g} steps or more (two one-sided tests). Holm: p, corrected\nfor the comparisons "
              "of the family."]
    for family in FAMILIES:
        found = list(compared(rows, analysis, family))
        said = "no test" if level is None or wrong else f"level {level:.3g}"
        lines += ["", f"{family} ({said})", COLUMNS, *found] if found else []
    lines += describe_thresholds(paths)
    lines += describe_blinding(paths)
    saw = {row["participant"] for row in rows_of(paths, ".briefings")
           if (row["check"], row["answer"]) == ("believed", RIGHT_BELIEF)}
    if saw:
        unaware = differences([answer for answer in answers if answer.participant not in saw])
        with_sham = {key: each for key, each in unaware.items() if "sham" in key}
        lines += ["", f"what has the sham, without the {len(saw)} who saw through it", COLUMNS,
                  *(line for family in FAMILIES for line in compared(with_sham, analysis, family))]
    return "\n".join(lines)
