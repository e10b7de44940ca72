# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A study as a folder that other programs read: the Brain Imaging Data Structure (BIDS), for behavioural recordings.

Of each participant, sub-CODE/beh/ has the answers of each part (_beh.tsv), and of each presentation that counts its
event and, at 1 kHz, forces and position (_physio.tsv.gz). Each table has a JSON file that says what its columns are."""

import csv
import gzip
import json
import os
import re
import shutil
from collections import defaultdict
from pathlib import Path

import chain
from delivery import AXES, MS_NS, rows_of
from perception import THRESHOLDS
from records import append_row, read_answers, read_rows, read_settings
from report import misfits
from trials import CONDITIONS, QUESTIONS, STEPS

EXPORT_COLUMNS = ["folder", "time_utc"]
BIDS_VERSION = "1.10.0"
MODELS = Path(__file__).with_name("models.R")
HANDEDNESS = {"both": "ambidextrous"}  # BIDS's word
CONDITION_WORDS = {"linear": "force proportional to the speed", "nonlinear": "arctangent of the speed",
                   "without": "taut strings without a force", "sham": "the force against the motion in the picture",
                   "with": "the force of the nonlinear controller"}


def column(text, units="", levels=None):
    return {"Description": text} | ({"Units": units} if units else {}) | ({"Levels": levels} if levels else {})


PARTICIPANT = {
    "participant_id": column("code of the participant"),
    "handedness": column("hand that writes"), "grip_hand": column("hand that held the grip"),
    "experience": column("how often such a device was held before"),
    "believed": column("what the participant chose, after the last clip, as what was done to the force"),
    "felt_N": column("least force that is told from none", "N"),
    "weber": column("least change of a force, as a part of it"),
    "turned_deg": column("least turn of a force", "degree"),
    "late_ms": column("least delay of a force behind a picture", "ms")}
BEHAVIOUR = {
    "trial": column("place in the order of presentation, from 1 on; the run of its recordings"),
    "condition": column("how the force was made", levels=CONDITION_WORDS),
    "clip": column("file name of the film"), "code": column("what the participant saw instead of the condition"),
    "question": column("what was asked", levels={name: text for part in QUESTIONS.values() for name, text in part.items()}),
    "response": column("answer", levels={str(number): step for number, step in enumerate(STEPS, 1)}),
    "time_utc": column("time of the answer")}
EVENT = {
    "onset": column("begin of the clip, from the begin of the recording", "s"), "duration": column("of the clip", "s"),
    "trial_type": column("the condition", levels=CONDITION_WORDS), "clip": BEHAVIOUR["clip"],
    "delivered_fraction": column("part of the force of the preview that reached the grip")}
PHYSIO = {
    "clip_time": column("running time of the clip; it stands still where a tick was late", "s"),
    **{f"{which}_force_{axis}": column(f"{text}, x right, y up, z towards the participant", "N")
       for which, text in (("wanted", "force by the film"), ("delivered", "force that the strings give")) for axis in AXES},
    **{f"position_{axis}": column("of the grip, from the centre of the frame", "m") for axis in AXES}}


def write_json(path, content):
    path.write_text(json.dumps(content, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


def write_table(path, columns, rows):
    """`rows`: by name of column; what is not there is n/a."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, delimiter="\t", lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[str(row.get(name, "")) or "n/a" for name in columns] for row in rows])


def label_of(participant):
    return re.sub("[^A-Za-z0-9]", "", participant)


def labels_of(participants):
    """Letters and digits are all that BIDS allows. Raises ValueError if two become the same."""
    labels = {each: label_of(each) for each in participants}
    if len(set(labels.values()) - {""}) < len(labels):
        raise ValueError("the codes of participants are not told apart by their letters and digits, which is all that BIDS "
                         f"allows: {', '.join(sorted(labels))}")
    return labels


def participant_row(answers, participant, label):
    row = {"participant_id": f"sub-{label}"}
    for each in read_rows(f"{answers}.briefings"):
        name = each["check"].replace("-", "_")
        if each["participant"] == participant and name in PARTICIPANT:
            row[name] = HANDEDNESS.get(each["answer"], each["answer"])
    for each in read_rows(f"{answers}.thresholds"):
        if each["participant"] == participant:
            row |= {name: each[name] for name in THRESHOLDS if each.get(name)}
    return row


def write_physio(path, haptic_trace):
    """Of each millisecond from the first tick of the clip, its newest tick. Returns the duration, s."""
    ticks = [row for row in rows_of(haptic_trace) if row["playing"] == "1"]
    begin_ns, last, lines = int(ticks[0]["monotonic_ns"]), 0, []
    for ms in range((int(ticks[-1]["monotonic_ns"]) - begin_ns) // MS_NS + 1):
        while last + 1 < len(ticks) and int(ticks[last + 1]["monotonic_ns"]) < begin_ns + (ms + 1) * MS_NS:
            last += 1
        tick = ticks[last]
        values = [int(tick["running_ns"]) / 1e9, *(float(tick[f"{name}_N"]) for name in PHYSIO if "force" in name),
                  *(float(tick[f"{name}_m"]) for name in PHYSIO if "position" in name)]
        lines.append("\t".join(f"{value:.6g}" for value in values) + "\n")
    path.write_bytes(gzip.compress("".join(lines).encode(), mtime=0))  # the same each time
    return len(lines) / 1000


def write_runs(answers, participant, label, folder, trials):
    """The recordings of what counts. `trials`: an answer of each, by number."""
    for shown in read_rows(f"{answers}.presentations"):
        trial = trials.get(int(shown["trial"])) if shown["trial"].isdigit() else None
        trace = Path(f"{answers}.traces/{shown['trace']}.haptic.csv")
        if shown["participant"] != participant or shown["problem"] or not trial or not trace.exists():
            continue
        name = f"sub-{label}_task-{trial.part}_run-{trial.trial}"
        duration_s = write_physio(folder / f"{name}_physio.tsv.gz", trace)
        write_table(folder / f"{name}_events.tsv", EVENT, [
            {"onset": "0", "duration": f"{duration_s:.3f}", "trial_type": trial.condition, "clip": Path(trial.clip).name,
             "delivered_fraction": shown["delivered_fraction"]}])


def export(path, folder):
    """Raises ValueError if there are no answers, or rather than to mix with an older folder."""
    answers, settings = read_answers(path), read_settings(path)
    if not answers:
        raise ValueError(f"{path}: there are no answers in it")
    of = defaultdict(list)
    for answer in answers:
        of[answer.participant].append(answer)
    labels, folder = labels_of(of), Path(folder)
    if os.path.lexists(folder) or not folder.parent.is_dir():
        raise ValueError(f"{folder}: " + ("exists; name a new folder, or remove that one" if os.path.lexists(folder) else
                                          f"there is no folder {folder.parent}"))
    folder.mkdir()
    with chain.session(path):
        append_row(path, ".exports", EXPORT_COLUMNS, [folder.resolve(), chain.utc_now()])
    write_json(folder / "dataset_description.json", {
        "Name": "A study of haptic feedback for films, with gst-spidar", "BIDSVersion": BIDS_VERSION, "DatasetType": "raw",
        "GeneratedBy": [{"Name": "gst-spidar", "Version": settings["version"]}]})
    (folder / "README").write_text(
        "What was asked and felt in each presentation that counts; docs/study.md of gst-spidar says how it was carried out.\n"
        "code/settings.json has all settings and the hash of each clip. `Rscript code/models.R .` fits mixed models.\n"
        + "Files were changed after they were written: `study.py report` names them.\n" * bool(misfits([path])),
        encoding="utf-8")
    (folder / "code").mkdir()
    write_json(folder / "code/settings.json", settings)
    shutil.copy(MODELS, folder / "code")
    write_table(folder / "participants.tsv", PARTICIPANT, [participant_row(path, each, labels[each]) for each in of])
    write_json(folder / "participants.json", PARTICIPANT)
    asked = {name: text for questions in settings["questions"].values() for name, text in questions.items()}
    behaviour = BEHAVIOUR | {"question": column("what was asked", levels=asked)}
    for participant, given in of.items():
        label = labels[participant]
        own = folder / f"sub-{label}" / "beh"
        own.mkdir(parents=True)
        for part in dict.fromkeys(answer.part for answer in given):
            write_table(own / f"sub-{label}_task-{part}_beh.tsv", BEHAVIOUR, [
                vars(answer) | {"clip": Path(answer.clip).name, "response": answer.answer}
                for answer in given if answer.part == part])
        write_runs(path, participant, label, own, {answer.trial: answer for answer in given})
    for part in CONDITIONS:
        described = {"beh": behaviour, "events": EVENT, "physio": {
            "SamplingFrequency": 1000, "StartTime": 0, "Columns": list(PHYSIO),
            "ManufacturersModelName": f"{settings['device']} {settings['profile']}".strip()} | PHYSIO}
        for kind, content in described.items():
            if next(folder.glob(f"sub-*/beh/*_task-{part}_*{kind}.tsv*"), None):  # BIDS has none without what it describes
                write_json(folder / f"task-{part}_{kind}.json", {"TaskName": part} | content)


def exports_with(path, participant):
    """For each earlier export: where this participant still is, and what to do; nothing if the folder is without them."""
    for row in read_rows(f"{path}.exports"):
        folder = Path(row["folder"])
        if (folder / f"sub-{label_of(participant)}").exists():
            yield f"{folder} still has what was exported of {participant}: remove it, and export again"
        elif not folder.exists():
            yield f"what was exported to {folder} on {row['time_utc']} has been moved or removed: look for copies of it"
