# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files of a study: answers, participants, presentations, and the settings that everything was made with.

Of ANSWERS.csv, the others have the name with more behind it: .settings.json, .participants, .presentations, .briefings,
.thresholds, .exports, .traces/, and .chain (chain.py)."""

import csv
import hashlib
import json
import re
from dataclasses import dataclass, fields, replace
from pathlib import Path

import chain
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
PARTICIPANT_COLUMNS = ["participant", "index", "time_utc"]
THRESHOLD_COLUMNS = ["participant", *THRESHOLDS, "trials", "time_utc"]  # empty where not asked, or the answers did not settle
PRESENTATION_COLUMNS = ["participant", "trial", "trace", "delivered_fraction", "problem", "time_utc"]
# Of each table, what cannot be missing.
NEEDED = {".participants": ["participant", "index"], ".presentations": PRESENTATION_COLUMNS[:5], ".thresholds": ["participant"],
          ".briefings": ["participant", "check", "answer"], ".exports": ["folder", "time_utc"]}


def append_row(answers, table, header, row):
    """Appends a line to one of chain.TABLES, after the header in a new file."""
    for each in [row] if chain.lines_of(answers, table) else [header, row]:
        chain.add_row(answers, table, chain.line_of(each))


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


def clips_of(settings):
    """Names in the order of the study, without the one to practise with."""
    return [name for name in settings["clips_sha256"] if name != settings["practice"]]


def digest_of_file(file):
    with open(file, "rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def names_of_clips(files, known):
    """By file: a clip is known by its content, and keeps the name of the file in which it first came. `known`: digests by
    name. Raises ValueError if two are the same."""
    digests, names = {}, {}
    for file in files:
        digest = digest_of_file(file)
        if digest in digests.values():
            raise ValueError(f"{file}: has the same content as another clip that is given; give each clip once, and another one to "
                             "practise with")
        name = next((name for name, each in known.items() if each == digest), Path(file).name)
        names[file] = f"{digest[:8]} {name}" if name in digests else name
        digests[names[file]] = digest
    return names, digests


def names_of(paths):
    """For each of several files of answers: what becomes of participants' codes in it, to which the machine is added, and of
    clips. Raises ValueError if they cannot be put together."""
    if len(paths) < 2:
        return [(path, str, str) for path in paths]
    found, machines, first, names = [], {}, None, {}
    for path in paths:
        settings = {"clips_sha256": {}, "practice": "", "host": ""} | (read_settings(path) or {})
        digests, host, given = settings["clips_sha256"], settings["host"], set(chain.lines_of(path, "")[1:])
        same = settings | {"host": "", "practice": digests.get(settings["practice"]), "clips_sha256": sorted(digests.values())}
        first = first or same
        require_same(path, first, same)
        names = {digest: name for name, digest in digests.items()} | names  # those of the first
        if host in machines:
            raise ValueError(f"{path}: is of the machine {host}, as another one is whose codes it may share")
        if any(2 * len(given & others) > min(len(given), len(others)) for others in machines.values()):
            raise ValueError(f"{path}: has answers of another file, given at the same times: a copy is no other machine")
        machines[host] = given
        found.append((path, lambda code, host=host: f"{code}@{host}" if code else code,
                      lambda clip, digests=digests: names.get(digests.get(clip), clip)))
    return found


def read_merged(paths):
    """All answers. Raises ValueError if there are none, or as names_of()."""
    answers = [replace(answer, participant=code(answer.participant), clip=clip(answer.clip)) for path, code, clip in names_of(paths)
               for answer in read_answers(path)]
    if not answers:
        raise ValueError(f"{paths[0]}: there are no answers in it")
    return answers


def read_rows(path):
    """Rows by the names of their columns; none if there is no such file. Raises ValueError that names file, line and what is
    wrong."""
    if not Path(path).exists():
        return []
    rows = []
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        try:
            columns = next(reader, [])
            missing = set(NEEDED.get(Path(path).suffix, ())) - set(columns)
            if columns and missing:
                raise ValueError(f"there is no column {', '.join(sorted(missing))}")
            for values in filter(None, reader):
                if len(values) != len(columns):
                    raise ValueError(f"{len(values)} columns, not {len(columns)}")
                rows.append(dict(zip(columns, values)))
        except (ValueError, csv.Error) as error:
            raise ValueError(f"{path}:{reader.line_num or 1}: {error}") from error
    return rows


class Participants:
    """Who takes part, and which order of trials each has. A place that somebody left is taken by the next one."""

    def __init__(self, answers):
        self.answers, self.path = Path(answers), f"{answers}.participants"
        self.rows = read_rows(self.path)
        for row in self.rows:
            if not row["index"].isdigit():
                raise ValueError(f'{self.path}: "{row["index"]}" of {row["participant"]} is not a whole number')

    def index_of(self, participant):
        taken = {row["participant"]: int(row["index"]) for row in self.rows}
        if participant in taken:
            return taken[participant]
        return min(set(range(len(taken) + 1)) - set(taken.values()))

    def register(self, participant):
        if not any(row["participant"] == participant for row in self.rows):
            append_row(self.answers, ".participants", PARTICIPANT_COLUMNS, [participant, self.index_of(participant), chain.utc_now()])

    def withdraw(self, participant):
        """Deletes all that is kept of a participant but that somebody has left. Raises ValueError if nothing is."""
        if not any(row["participant"] == participant for row in self.rows):
            raise ValueError(f'{self.answers}: nobody in it is called "{participant}"')
        traces = self.traces_of(participant)
        files = [f".traces/{trace}{kind}.csv" for trace in traces for kind in chain.TRACES]
        is_theirs = lambda row: row != "" and next(csv.reader([row]))[0] == participant
        with chain.session(self.answers):
            chain.forget(self.answers, lambda name, row: name in traces or name in files or is_theirs(row))
            for file in files:
                Path(f"{self.answers}{file}").unlink(missing_ok=True)
            for table in chain.TABLES:
                if lines := chain.lines_of(self.answers, table):
                    left = [lines[0], *(line for line in lines[1:] if not is_theirs(line))]
                    chain.replace_file(f"{self.answers}{table}", "\n".join([*left, ""]))

    def traces_of(self, participant):
        """As the presentations say; of what was interrupted before it was one, by the longest code that the name has."""
        shown = {row["trace"]: row["participant"] for row in read_rows(f"{self.answers}.presentations")}
        codes = sorted((row["participant"] for row in self.rows), key=len, reverse=True)
        by_name = lambda trace: next((code for code in codes if re.fullmatch(re.escape(code) + r"-\d+(-\d+)?", trace)), None)
        traces = {re.sub(r"^\.traces/|(\.(haptic|screen))?\.csv$", "", name) for name in chain.files_there(self.answers)}
        return {trace for trace in {*traces, *chain.named(self.answers, "clip")} if (shown.get(trace) or by_name(trace)) == participant}


def differences(old, new, name=""):
    """What differs between two trees of settings, in words."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in {**old, **new}:
            yield from differences(old.get(key), new.get(key), f"{name} {key}".strip())
    elif old != new:
        yield f"{name} was {json.dumps(old, ensure_ascii=False)}, not {json.dumps(new, ensure_ascii=False)}"


def read_settings(answers, part="settings"):
    """Nothing if the study has not begun. Raises ValueError if its settings are lost. `part`: or the "preview"."""
    path = Path(f"{answers}{chain.SETTINGS}")
    if path.exists():
        try:
            settings = json.loads(path.read_text(encoding="utf-8"))
            preview = settings.pop("preview")
            return preview if part == "preview" else settings
        except (ValueError, RecursionError, AttributeError, TypeError, LookupError) as error:
            raise ValueError(f"{path}: is not as this program wrote it ({error}); put it back as it was") from error
    if part == "preview" or read_answers(answers):
        raise ValueError(f"{path}: is missing, so nobody knows with what {answers} was made; put it back")
    return None


def digest_of(settings):
    return hashlib.sha256(json.dumps(settings, ensure_ascii=False, sort_keys=True).encode()).hexdigest()


def unfit(answers, path, settings):
    """Answers that belong to no presentation that counts, or to another one than was shown, in sentences."""
    counted = {(row["participant"], row["trial"]) for row in read_rows(f"{path}.presentations") if not row["problem"]}
    participants, shown, asked = Participants(path), {}, set()
    for answer in answers:
        who, said = answer.participant, f"{answer.participant}, trial {answer.trial}, {answer.question}"
        if who not in shown:
            shown[who] = schedule(clips_of(settings), participants.index_of(who), settings["seed"])
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


def write_settings(answers, settings, preview):
    """`preview`: what was found in the clips."""
    chain.write_file(answers, chain.SETTINGS, json.dumps(settings | {"preview": preview}, ensure_ascii=False) + "\n")
