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

COLUMNS = ["file", "salt", "digest", "link"]
# In place of a file. CUT_OFF: the entry before is of what was not written any more. WITHDRAWN, with a number: of entries
# whose salt is gone, because their participant is; and, with a salt, the entry of the digests of these.
SESSION, END, CUT_OFF, WITHDRAWN = "session", "end", "cut off", "withdrawn"
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
    """The lines of a table with its head, as they are written."""
    path = Path(f"{answers}{table}")
    return path.read_text(encoding="utf-8").split("\n")[:-1] if path.exists() else []


def matched(entries, table, rows):
    """For each row its entry, or None. Rows are in the order of their entries, unless somebody withdrew."""
    left, found = [entry for entry in entries if entry["file"] == table], []
    for row in rows:
        entry = next((each for each in left if digest_of(each["salt"], table, row.encode()) == each["digest"]), None)
        if entry:
            left.remove(entry)
        found.append(entry)
    return found


def digests(entries):
    return ",".join(entry["digest"] for entry in entries).encode()


def forget(answers, rows, files):
    """Of a participant who withdraws: nobody can try any more what their entries were of. `rows`: by table."""
    entries = read(answers)
    name = f"{WITHDRAWN} {1 + sum(entry['file'].startswith(WITHDRAWN) and entry['salt'] != '' for entry in entries)}"
    gone = [entry for table, lines in rows.items() for entry in matched(entries, table, lines) if entry]
    gone = [entry for entry in entries if entry in gone or entry["file"] in files]
    for entry in gone:
        entry["file"], entry["salt"] = name, ""
    write(answers, entries)
    add(answers, name, digests(gone))


def is_there(answers, entry):
    if entry["file"] in TABLES:
        return any(digest_of(entry["salt"], entry["file"], row.encode()) == entry["digest"]
                   for row in rows_of(answers, entry["file"]))
    return True


def begin(answers, machine):
    """A session. A row is written after its entry: if the power failed between the two, the chain says so, and what was
    written of the row is taken away."""
    for path in (Path(f"{answers}{table}") for table in TABLES):
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        if text and not text.endswith("\n"):
            replace_file(path, text[:text.rfind("\n") + 1])
    entries = read(answers)
    if entries and not is_there(answers, entries[-1]):
        add(answers, CUT_OFF, b"")
    for file in FILES:
        if Path(f"{answers}{file}").exists() and not any(entry["file"] == file for entry in entries):
            add_file(answers, file)
    add(answers, SESSION, machine.encode())


def end(answers):
    """Of a session. Returns what somebody may note."""
    return add(answers, END, b"")[:NOTED]


def ends(answers):
    return [entry["link"][:NOTED] for entry in read(answers) if entry["file"] == END]


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
        for n, (row, entry) in enumerate(zip(rows, found), 1):
            if not entry:
                yield f"{answers}{table}:{n}: was not written so: {row}"
        missing = sum(entry["file"] == table for entry in written) - sum(map(bool, found))
        if missing:
            yield f"{answers}{table}: {missing} of the rows that were written are not in it"
    gone = {entry["file"]: entry for entry in written if entry["file"].startswith(WITHDRAWN) and entry["salt"]}
    for name in dict.fromkeys([*gone, *(entry["file"] for entry in written if not entry["salt"])]):
        its, entry = [each for each in written if each["file"] == name and not each["salt"]], gone.get(name)
        if not entry or digest_of(entry["salt"], name, digests(its)) != entry["digest"]:
            yield f"{path_of(answers)}: entries are unreadable that are not of who withdrew"
    left = sum(row.startswith(",") for row in rows_of(answers, ".participants"))
    if left != len(gone):
        yield f"{path_of(answers)}: {len(gone)} withdrew, and {left} of the participants"
    newest = {entry["file"]: entry for entry in written if entry["file"] in FILES or entry["file"].startswith(".traces/")}
    for file in dict.fromkeys([*FILES, *newest]):
        path, entry = Path(f"{answers}{file}"), newest.get(file)
        if not path.exists():
            yield f"{path}: is missing"
        elif not entry or digest_of(entry["salt"], file, path.read_bytes()) != entry["digest"]:
            yield f"{path}: is not as it was written"
