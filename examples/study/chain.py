# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A chain of digests over all that a study keeps, written as it goes: what is changed, taken out or added later does not fit.

ANSWERS.csv.chain has an entry for each row of a table, each file that is written as a whole, and each session. Its digest
is of a random salt, the name of the file and what was written; its link of the link before and the digest. Who rewrites
files and chain together is found only by a link that was noted elsewhere, which the end of a session prints.
"""

import csv
import hashlib
import os
import secrets
from pathlib import Path

COLUMNS = ["file", "salt", "digest", "link"]  # file and salt: empty once the participant has withdrawn
SESSION, CUT_OFF = "session", "cut off"  # in place of a file; the entry before is of what was not written any more
TABLES = ("", ".participants", ".presentations", ".briefings", ".thresholds", ".exports")
FILES = (".settings.json", ".preview.json")
NOTED = 8  # characters of a link, which somebody can note: 32 bits


def replace_file(path, text):
    """The file has the old or the new content, whatever happens."""
    new = Path(f"{path}.new")
    with open(new, "w", encoding="utf-8", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(new, path)


def digest_of(salt, file, content):
    return hashlib.sha256(b"\0".join((salt.encode(), file.encode(), content))).hexdigest()


def link_of(before, digest):
    return hashlib.sha256((before + digest).encode()).hexdigest()


def path_of(answers):
    return Path(f"{answers}.chain")


def read(answers):
    if not path_of(answers).exists():
        return []
    with open(path_of(answers), encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file) if row["link"]]  # the last line may have been cut off


def write(answers, entries):
    lines = [",".join(COLUMNS), *(",".join(entry[name] for name in COLUMNS) for entry in entries)]
    replace_file(path_of(answers), "\n".join(lines) + "\n")


def add(answers, file, content):
    """`file`: what its name has beyond that of the answers. Returns the new link."""
    with open(path_of(answers), "a+b") as chain:
        end = chain.seek(0, os.SEEK_END)
        chain.seek(max(0, end - 4096))
        last = chain.read()
        whole = last[:last.rfind(b"\n") + 1]
        chain.truncate(end - len(last) + len(whole))
        before = whole.splitlines()[-1].decode().split(",")[-1] if whole else ""
        if not whole:
            chain.write((",".join(COLUMNS) + "\n").encode())
            before = COLUMNS[-1]
        salt = secrets.token_hex(16)
        digest = digest_of(salt, file, content)
        link = link_of(before, digest)
        chain.write(f"{file},{salt},{digest},{link}\n".encode())
        chain.flush()
        os.fsync(chain.fileno())
    return link


def add_file(answers, file):
    return add(answers, file, Path(f"{answers}{file}").read_bytes())


def rows_of(answers, table):
    """The lines of a table without its head, as they are written."""
    path = Path(f"{answers}{table}")
    return path.read_text(encoding="utf-8").split("\n")[1:-1] if path.exists() else []


def matched(entries, table, rows):
    """For each row its entry, or None. Rows are in the order of their entries, unless somebody withdrew."""
    left, found = [entry for entry in entries if entry["file"] == table and entry["salt"]], []
    for row in rows:
        entry = next((each for each in left if digest_of(each["salt"], table, row.encode()) == each["digest"]), None)
        if entry:
            left.remove(entry)
        found.append(entry)
    return found


def forget(answers, rows, files):
    """Of a participant who withdraws: nobody can try any more what their entries were of. `rows`: by table."""
    entries = read(answers)
    gone = [entry for table, lines in rows.items() for entry in matched(entries, table, lines) if entry]
    for entry in entries:
        if entry in gone or entry["file"] in files:
            entry["file"] = entry["salt"] = ""
    write(answers, entries)


def is_there(answers, entry):
    if entry["file"] in TABLES:
        return any(digest_of(entry["salt"], entry["file"], row.encode()) == entry["digest"]
                   for row in rows_of(answers, entry["file"]))
    return True


def begin(answers, machine):
    """A session. A row is written after its entry: if the power failed between the two, the chain says so."""
    entries = read(answers)
    if entries and not is_there(answers, entries[-1]):
        add(answers, CUT_OFF, b"")
    for file in FILES:
        if Path(f"{answers}{file}").exists() and not any(entry["file"] == file for entry in entries):
            add_file(answers, file)
    return add(answers, SESSION, machine.encode())


def ends(answers):
    """The link at the end of each session: what somebody may have noted."""
    entries = read(answers)
    begins = [n for n, entry in enumerate(entries) if entry["file"] == SESSION]
    return [entries[end - 1]["link"][:NOTED] for end in [*begins[1:], len(entries)] if begins]


def misfits(answers):
    """What is not as it was written, in sentences."""
    entries = read(answers)
    if not entries:
        yield f"{path_of(answers)}: is missing, so nobody knows whether anything was changed"
        return
    before = COLUMNS[-1]
    for n, entry in enumerate(entries, 2):
        if entry["link"] != link_of(before, entry["digest"]):
            yield f"{path_of(answers)}:{n}: does not follow from the line before"
        before = entry["link"]
    written = [entry for entry, after in zip(entries, [*entries[1:], {"file": ""}]) if after["file"] != CUT_OFF]
    for table in TABLES:
        rows = rows_of(answers, table)
        found = matched(written, table, rows)
        for n, (row, entry) in enumerate(zip(rows, found), 2):
            if not entry:
                yield f"{answers}{table}:{n}: was not written so: {row}"
        missing = sum(entry["file"] == table and entry["salt"] != "" for entry in written) - sum(map(bool, found))
        if missing:
            yield f"{answers}{table}: {missing} of the rows that were written are not in it"
    newest = {entry["file"]: entry for entry in written if entry["file"] in FILES or entry["file"].startswith(".traces/")}
    for file in dict.fromkeys([*FILES, *newest]):
        path, entry = Path(f"{answers}{file}"), newest.get(file)
        if not path.exists():
            yield f"{path}: is missing"
        elif not entry or digest_of(entry["salt"], file, path.read_bytes()) != entry["digest"]:
            yield f"{path}: is not as it was written"
