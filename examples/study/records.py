# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files of a study: answers, participants, presentations, and the settings that everything was made with.

Of ANSWERS.csv, the others have the name with more behind it: .settings.json, .preview.json, .participants,
.presentations, .briefings, .thresholds, .exports, .traces/, and .chain (chain.py)."""

import csv
import hashlib
import io
import json
import os
import re
from dataclasses import dataclass, fields, replace
from datetime import datetime, timezone
from pathlib import Path

import chain
from chain import replace_file
from perception import THRESHOLDS
from trials import CONDITIONS, STEPS, Trial, schedule


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

    def shown(self):
        return Trial(self.trial, self.part, self.condition, self.code, self.clip)


COLUMNS = [field.name for field in fields(Answer)]
PARTICIPANT_COLUMNS = ["participant", "index", "time_utc"]  # participant: empty once they have withdrawn
THRESHOLD_COLUMNS = ["participant", *THRESHOLDS, "trials", "time_utc"]  # empty where not asked, or the answers did not settle
PRESENTATION_COLUMNS = ["participant", "trial", "trace", "delivered_fraction", "problem", "time_utc"]


def utc_now():
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def line_of(row):
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(row)
    return text.getvalue().replace("\n", " ")


def append_row(answers, table, header, row):
    """Appends a line to one of chain.TABLES, after the header in a new file, and flushes it to the disk."""
    path = Path(f"{answers}{table}")
    is_new = not path.exists() or not path.stat().st_size
    for line in map(line_of, [header, row] if is_new else [row]):
        chain.add(answers, table, line.encode())
        with open(path, "a", encoding="utf-8", newline="") as file:
            file.write(line + "\n")
            file.flush()
            os.fsync(file.fileno())


def parse_answer(row):
    if len(row) != len(COLUMNS):
        raise ValueError(f"{len(row)} columns, not {len(COLUMNS)}")
    answer = Answer(*row)
    if answer.condition not in CONDITIONS.get(answer.part, ()):
        raise ValueError(f'"{answer.part}, {answer.condition}" is not a part with one of its conditions')
    if answer.answer not in ("1", "2", "3", "4", "5"):
        raise ValueError(f'"{answer.answer}" is not a number from 1 to {len(STEPS)}')
    if not answer.trial.isdigit():
        raise ValueError(f'"{answer.trial}" is not a number of a trial')
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


def names_of(paths):
    """For each of several files of answers, what becomes of the codes in it: with the machine, where there are more.
    Raises ValueError if they cannot be put together."""
    first, machines = read_settings(paths[0]) or {}, []
    for path in paths if len(paths) > 1 else ():
        settings = read_settings(path) or {}
        require_same(path, first | {"host": ""}, settings | {"host": ""})
        if settings.get("host") in machines:
            raise ValueError(f"{path}: is of the machine {settings['host']}, as another one is whose codes it may share")
        machines.append(settings.get("host"))
    return [(path, lambda code, machine=machine: f"{code}@{machine}" if code else code) for path, machine in
            zip(paths, machines)] or [(paths[0], lambda code: code)]


def read_merged(paths):
    """All answers. Raises ValueError if there are none, or as names_of()."""
    answers = [replace(answer, participant=name(answer.participant)) for path, name in names_of(paths)
               for answer in read_answers(path)]
    if not answers:
        raise ValueError(f"{paths[0]}: there are no answers in it")
    return answers


def read_rows(path):
    """Rows by the names of their columns; none if there is no such file."""
    if not Path(path).exists():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Participants:
    """Who takes part, and which order of trials each has. A place that somebody left is taken by the next one."""

    def __init__(self, answers):
        self.answers, self.path = Path(answers), f"{answers}.participants"
        self.rows = read_rows(self.path)

    def index_of(self, participant):
        taken = {row["participant"]: int(row["index"]) for row in self.rows if row["participant"]}
        if participant in taken:
            return taken[participant]
        return min(set(range(len(taken) + 1)) - set(taken.values()))

    def register(self, participant):
        if not any(row["participant"] == participant for row in self.rows):
            append_row(self.answers, ".participants", PARTICIPANT_COLUMNS, [participant, self.index_of(participant), utc_now()])

    def withdrew(self):
        return sum(not row["participant"] for row in self.rows)

    def withdraw(self, participant):
        """Deletes all that is kept of a participant but that somebody has left. Raises ValueError if nothing is."""
        if not any(row["participant"] == participant for row in self.rows):
            raise ValueError(f'{self.answers}: nobody in it is called "{participant}"')
        traces = list(self.traces_of(participant))
        rows = {table: [row for row in chain.rows_of(self.answers, table) if next(csv.reader([row]))[0] == participant]
                for table in chain.TABLES}
        chain.forget(self.answers, rows, [f".traces/{trace.name}" for trace in traces])
        for trace in traces:
            trace.unlink()
        for table, gone in rows.items():
            path = Path(f"{self.answers}{table}")
            header, *lines, _ = path.read_text(encoding="utf-8").split("\n") if gone else [""] * 2
            if table == ".participants":
                left = line_of(["", *next(csv.reader(gone))[1:]])
                chain.add(self.answers, table, left.encode())
                lines = [left if line in gone else line for line in lines]
            if gone:
                replace_file(path, "\n".join([header, *(line for line in lines if line not in gone), ""]))

    def traces_of(self, participant):
        """As the presentations say; of what was interrupted before it was one, by the longest code that the name has."""
        shown = {row["trace"]: row["participant"] for row in read_rows(f"{self.answers}.presentations")}
        codes = sorted((row["participant"] for row in self.rows if row["participant"]), key=len, reverse=True)
        for trace in list(Path(f"{self.answers}.traces").glob("*.csv")):
            name = re.sub(r"(\.(haptic|screen))?\.csv$", "", trace.name)
            by_name = (code for code in codes if re.fullmatch(re.escape(code) + r"-\d+(-\d+)?", name))
            if (shown.get(name) or next(by_name, None)) == participant:
                yield trace


def differences(old, new, name=""):
    """What differs between two trees of settings, in words."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in {**old, **new}:
            yield from differences(old.get(key), new.get(key), f"{name} {key}".strip())
    elif old != new:
        yield f"{name} was {json.dumps(old, ensure_ascii=False)}, not {json.dumps(new, ensure_ascii=False)}"


def read_settings(answers, kind="settings"):
    """Nothing if the study has not begun. Raises ValueError if its settings are lost. `kind`: or the "preview"."""
    path = Path(f"{answers}.{kind}.json")
    if path.exists():
        try:
            return json.loads(path.read_text(encoding="utf-8"))
        except (ValueError, RecursionError) as error:
            raise ValueError(f"{path}: is not as this program wrote it ({error}); put it back as it was") from error
    if kind == "preview" or read_answers(answers):
        raise ValueError(f"{path}: is missing, so nobody knows with what {answers} was made; put it back")
    return None


def digest_of(settings):
    return hashlib.sha256(json.dumps(settings, ensure_ascii=False, sort_keys=True).encode()).hexdigest()


def unfit(answers, path, settings):
    """Answers that belong to no presentation that counts, or to another one than was shown, in sentences."""
    counted = {(row["participant"], row["trial"]) for row in read_rows(f"{path}.presentations") if not row["problem"]}
    clips = [clip for clip in settings["clips_sha256"] if clip != settings["practice"]]
    participants, shown, asked = Participants(path), {}, set()
    for answer in answers:
        who, said = answer.participant, f"{answer.participant}, trial {answer.trial}, {answer.question}"
        if who not in shown:
            shown[who] = schedule(clips, participants.index_of(who), settings["seed"])
        if (who, answer.trial, answer.question) in asked:
            yield f"{said}: answered twice, as where files of two machines were put together; give both files to report"
        elif (who, str(answer.trial)) not in counted:
            yield f"{said}: no presentation of it counts"
        elif answer.shown() not in shown[who]:
            yield f"{said}: {answer.condition} of {answer.clip} was not what was shown"
        asked.add((who, answer.trial, answer.question))


def require_same(answers, old, new):
    """Raises ValueError that says what is no longer as it was when the study began."""
    found = list(differences(old, new))
    if found:
        raise ValueError(f"{answers} was begun with other settings: {'; '.join(found)}. Give the same again, or begin "
                         "another file")


def write_settings(answers, settings, clips):
    """`clips`: what their preview found."""
    replace_file(f"{answers}.preview.json", json.dumps(clips, ensure_ascii=False) + "\n")
    replace_file(f"{answers}.settings.json", json.dumps(settings, ensure_ascii=False, indent=1) + "\n")
    for file in chain.FILES:
        chain.add_file(answers, file)
