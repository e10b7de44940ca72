# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A chain of digests over all that a study keeps, written as it goes: what is changed, moved, removed or added later
does not fit.

ANSWERS.csv.chain has an entry for each session and its end, each row of a table, each file, each clip before it is
played, and each look at the answers. An entry's digest covers a random salt, its time, its name and its content; its
link covers the link before, its kind and its digest. A link therefore stands for all that came before, and whoever
writes the chain anew changes the codes that sessions have printed. When a participant withdraws, times, names and salts
of their entries are deleted, so that nobody can try what the digests were of.
"""

import csv
import fcntl
import hashlib
import io
import os
import platform
import secrets
from contextlib import contextmanager
from datetime import datetime, timezone
from pathlib import Path

COLUMNS = ["kind", "time_utc", "name", "salt", "digest", "link"]
TABLES = ("", ".presentations", ".briefings", ".thresholds", ".exports", ".participants")  # where withdraw() looks
SETTINGS, LOCK = ".settings.json", ".lock"
TRACES = ("", ".haptic", ".screen")
# The kinds of entries, and what each may follow. The name of a session is its machine, of a row its table, of a file
# what its path has beyond that of the answers, of a clip that of its traces, of a look the number of participants;
# `withdrawn` names the lines that were made unreadable. A session that was killed has no end; if the power failed
# before the content of its last entry was written, the next session says that this was `cut off`.
WITH_CONTENT = ("row", "file")
OF_PEOPLE = (*WITH_CONTENT, "clip")
BEFORE = ("session", "cut off", *OF_PEOPLE, "look", "withdrawn")
FOLLOWS = (dict.fromkeys((*OF_PEOPLE, "look", "withdrawn", "end"), BEFORE)
           | {"session": ("", "end", *BEFORE), "cut off": ("session",)})
NOTED = 8  # characters of a link, which somebody can note: 32 bits


def utc_now():
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def line_of(row):
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(row)
    return text.getvalue().replace("\n", " ")


def replace_file(path, text):
    """The file has the old or the new content, whatever happens."""
    new = Path(f"{path}.new")
    with open(new, "w", encoding="utf-8", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(new, path)


def hash_of(*parts):
    return hashlib.sha256(b"\0".join(part if isinstance(part, bytes) else part.encode() for part in parts)).hexdigest()


def fits(entry, content=b""):
    return entry["digest"] == hash_of(entry["salt"], entry["time_utc"], entry["name"], content)


def lines_of(answers, name):
    path = Path(f"{answers}{name}")
    return path.read_bytes().decode().removesuffix("\n").split("\n") if path.exists() and path.stat().st_size else []


def read(answers):
    """Entries by line, from 2 on. The last line may have been cut off."""
    path = Path(f"{answers}.chain")
    lines = path.read_bytes().decode().split("\n")[1:-1] if path.exists() else []
    rows = (row if len(row) == len(COLUMNS) else [""] * len(COLUMNS) for row in csv.reader(lines))
    return dict(enumerate((dict(zip(COLUMNS, row)) for row in rows), 2))


def after(link, kind, name, content=b""):
    entry = {"kind": kind, "time_utc": utc_now(), "name": name, "salt": secrets.token_hex(16)}
    entry["digest"] = hash_of(entry["salt"], entry["time_utc"], name, content)
    return entry | {"link": hash_of(link, kind, entry["digest"])}


def add(answers, kind, name="", content=b""):
    with open(f"{answers}.chain", "a+b") as chain:
        chain.seek(0)
        whole = chain.read().rpartition(b"\n")[0].decode().split("\n")
        head = "" if whole[0] else line_of(COLUMNS) + "\n"
        chain.truncate(0 if head else len("\n".join(whole).encode()) + 1)
        link = COLUMNS[-1] if head else whole[-1].rpartition(",")[2]
        chain.write((head + line_of(after(link, kind, name, content).values()) + "\n").encode())
        chain.flush()
        os.fsync(chain.fileno())


def add_row(answers, table, line):
    add(answers, "row", table, line.encode())
    with open(f"{answers}{table}", "a", encoding="utf-8", newline="") as file:
        file.write(line + "\n")
        file.flush()
        os.fsync(file.fileno())


def write_file(answers, name, text):
    add(answers, "file", name, text.encode())
    replace_file(f"{answers}{name}", text)


def add_file(answers, name):
    """Of one that is there."""
    with open(f"{answers}{name}", "rb") as file:
        os.fsync(file.fileno())
        add(answers, "file", name, file.read())


def cut_off(entries):
    return {n - 2 for n, entry in entries.items() if entry["kind"] == "cut off"}


def matched(entries, table, rows):
    """For each row the line of its entry, or None: both have one order. And how many entries have no row."""
    cut, found, begin = cut_off(entries), [], 0
    left = [n for n, entry in entries.items()
            if n not in cut and entry["salt"] and (entry["kind"], entry["name"]) == ("row", table)]
    for row in rows:
        place = next((i for i in range(begin, len(left)) if fits(entries[left[i]], row.encode())), None)
        found.append(None if place is None else left[place])
        begin = begin if place is None else place + 1
    return found, len(left) - sum(map(bool, found))


def forget(answers, is_of):
    """What is of a participant who withdraws, as `is_of(name, row)` tells."""
    entries, rows = read(answers), {}
    for table in TABLES:
        lines = lines_of(answers, table)
        rows |= dict(zip(matched(entries, table, lines)[0][1:], lines[1:]))
    gone = {n for n, entry in entries.items() if entry["salt"] and entry["kind"] in OF_PEOPLE and
            (n in cut_off(entries) or is_of(entry["name"], rows.get(n, "")))}
    if not gone:  # what remains of a withdrawal that was interrupted
        return
    for n in gone:
        entries[n] |= dict.fromkeys(("time_utc", "name", "salt"), "")
    last = after(entries[max(entries)]["link"], "withdrawn", " ".join(map(str, sorted(gone))))
    lines = [COLUMNS, *(entry.values() for entry in (*entries.values(), last))]
    replace_file(f"{answers}.chain", "".join(line_of(line) + "\n" for line in lines))


@contextmanager
def session(answers):
    """All is written in one, after its entry. What is left of the last one without having been written as a whole is
    removed. Prints what somebody is to note. Raises ValueError while there is another one."""
    with open(f"{answers}{LOCK}", "ab") as lock:  # a file that is never replaced, as the chain is by forget()
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise ValueError(f"{answers}: another program has a session of this study; wait until it has "
                             "ended") from error
        for name in (*TABLES, SETTINGS, ".chain"):
            Path(f"{answers}{name}.new").unlink(missing_ok=True)  # replace_file() was killed
        for path in (Path(f"{answers}{table}") for table in TABLES):
            text = path.read_text(encoding="utf-8") if path.exists() else ""
            if text and not text.endswith("\n"):
                replace_file(path, text[:text.rfind("\n") + 1])
        last = [*read(answers).values()][-1:]
        is_lost = any(entry["kind"] in WITH_CONTENT
                      and not any(fits(entry, each) for each in contents_of(answers, entry)) for entry in last)
        add(answers, "session", platform.node())
        if is_lost:
            add(answers, "cut off")
        try:
            yield
        finally:
            add(answers, "end")
            print(f"\nNote with the form of consent: {codes(answers)[-1]}")


def contents_of(answers, entry):
    """What an entry may have been of."""
    path = Path(f"{answers}{entry['name']}")
    if entry["kind"] == "row":
        return [line.encode() for line in lines_of(answers, entry["name"])]
    return [path.read_bytes()] if path.exists() else []


def codes(answers):
    """What the ends of sessions have printed; last, of what came after them."""
    entries = read(answers)
    return [entry["link"][:NOTED] for n, entry in entries.items() if entry["kind"] == "end" or n == max(entries)]


def named(answers, kind):
    return [entry["name"] for entry in read(answers).values() if entry["kind"] == kind]


def registered(answers):
    """When the settings were written, and the code of that session."""
    entries = read(answers)
    line = next((n for n, entry in entries.items() if (entry["kind"], entry["name"]) == ("file", SETTINGS)), 0)
    end = next((entry for n, entry in entries.items() if entry["kind"] == "end" and n > line > 0), {"link": ""})
    return entries.get(line, {"time_utc": ""})["time_utc"], end["link"][:NOTED]


def walk(entries):
    """By line, what is wrong with an entry after those before it; and the clips in which the session was killed."""
    wrong, killed, played, files, link, state, clip = {}, set(), set(), {SETTINGS}, COLUMNS[-1], "", ""
    cut = cut_off(entries)
    gone = {n for entry in entries.values() if entry["kind"] == "withdrawn" for n in entry["name"].split()}
    for n, entry in entries.items():
        kind, name = entry["kind"], entry["name"]
        if entry["link"] != hash_of(link, kind, entry["digest"]):
            wrong[n] = "does not follow from the line before"
        elif state not in FOLLOWS.get(kind, ()):
            wrong[n] = f'"{kind}" does not come after "{state}"'
        elif not entry["salt"]:
            if kind not in OF_PEOPLE or name or entry["time_utc"] or str(n) not in gone:
                wrong[n] = "is unreadable, and not of who withdrew"
        elif kind not in WITH_CONTENT and not fits(entry):
            wrong[n] = "is not as it was written"
        elif (name not in TABLES if kind == "row" else name not in files if kind == "file"
              else kind == "clip" and name in played):
            wrong[n] = f'"{kind} {name}" has no place here'
        if kind in ("session", "end", "clip"):
            killed, files, clip = killed | {clip}, files & {SETTINGS}, ""
        if kind == "clip":
            played, files, clip = played | {name}, {f".traces/{name}{trace}.csv" for trace in TRACES}, name
        elif kind == "row" and name == ".presentations" and n not in cut:
            files, clip = set(), ""
        elif kind == "file" and n not in cut:
            files = files - {name}
        link, state = entry["link"], kind
    return wrong, (killed | {clip}) - {""}


def files_there(answers):
    folder, name = Path(answers).parent, Path(answers).name
    beside = {each.name[len(name):] for each in folder.iterdir() if each.is_file() and each.name.startswith(f"{name}.")}
    return beside - {*TABLES, ".chain", LOCK} | {f".traces/{each.name}" for each in Path(f"{answers}.traces").glob("*")}


def misfits(answers):
    """What is not as it was written, in sentences."""
    entries, cut = read(answers), cut_off(read(answers))
    if not entries:
        yield f"{answers}.chain: is missing, so nobody knows whether anything was changed"
        return
    wrong, killed = walk(entries)
    if lines_of(answers, ".chain")[0] != line_of(COLUMNS):
        wrong = {1: "is not as it was written"} | wrong
    yield from (f"{answers}.chain:{n}: {said}" for n, said in wrong.items())
    for table in TABLES:
        rows = lines_of(answers, table)
        found, missing = matched(entries, table, rows)
        yield from (f"{answers}{table}:{n}: was not written so, or not here: {row}"
                    for n, (row, entry) in enumerate(zip(rows, found), 1) if not entry)
        if missing:
            yield f"{answers}{table}: {missing} of the rows that were written are not in it"
    files = {entry["name"]: entry for n, entry in entries.items()
             if entry["kind"] == "file" and entry["salt"] and n not in cut}
    for name in sorted({SETTINGS} | files.keys() | files_there(answers)):
        path = Path(f"{answers}{name}")
        if not path.exists():
            yield f"{path}: is missing"
        elif name in files and not fits(files[name], path.read_bytes()):
            yield f"{path}: is not as it was written"
        elif name not in files and not any(name == f".traces/{clip}{trace}.csv" for clip in killed for trace in TRACES):
            yield f"{path}: is not in the chain"
