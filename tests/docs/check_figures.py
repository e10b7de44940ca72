#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Whether each figure of the pages has a command that prints it, by figures.tsv.

check_figures.py SOURCE: each table with numbers, and each section whose text has a number with a unit, has a row in
figures.tsv, and each row a place on a page and a command that is there. check_figures.py SOURCE RESULTS: also, that the
figures of each table are in RESULTS/NAME.txt, which tests/bench/results.sh has written; a release runs this. A row:

    page, heading, part     the part is `table` or `text`; of several tables below one heading, `table 2` and so on; `*` for
                            both: what else the page has
    command                 what prints the figures, or `-`: they were not measured here, and the note says what they are, by
                            one of NOT_MEASURED
    name, differs           the file of results.sh, and by how much, in parts of a figure, it may differ from run to run and
                            from machine to machine; `0.05: 84.2 63` has which of the figures, always of a text; `-`: compare it
                            yourself
    note                    what else is to be known, such as why it is not measured"""

import csv
import re
import sys
from pathlib import Path

TABLE = Path(__file__).with_name("figures.tsv")
COLUMNS = ["page", "heading", "part", "command", "name", "differs", "note"]
NUMBER = r"[-−]?\d+(?:[ ,]\d{3})*(?:\.\d+)?(?:e-?\d+)?"
UNITS = (r"(?:%|°|ms|µs|ns|s|m|mm|cm|px|N|mN|mJ|J|Hz|kHz|MHz|rad|mrad|µN|µm|kB|MB|GB|KiB|MiB|bits?|V|A|W|K|grey|frames|films|clips|"
         r"times|steps|lines|seconds|minutes|hours|days|people|participants|studies|blocks|pictures|samples|points|cells|strings|ticks|"
         r"presentations|cores|processors)")
MEASURED = re.compile(rf"(?<![\w.]){NUMBER}(?: ?{UNITS}(?![\w-])|×)")
NOT_MEASURED = ("constant", "derived", "of others", "of another page", "generated")  # where the note begins


def parts_of(text):
    """(heading, part, its lines) in the order of the page; code, comments and links are left out."""
    heading, tables, paragraph, table = "", 0, [], []
    for line in [*text.split("\n"), "# end"]:
        if line.startswith("|") and not line.startswith("| !"):
            table.append(line)
            continue
        if table:
            tables += 1
            yield heading, "table" if tables == 1 else f"table {tables}", table
            table = []
        if line.startswith("#"):
            yield heading, "text", paragraph
            heading, tables, paragraph = line.strip("# "), 0, []
        elif not line.startswith(("    ", "<!--")):
            paragraph.append(re.sub(r"\]\([^)]*\)|`[^`]*`", "", line))


def figures_of(lines):
    """The numbers in the cells of a table, without its head and first column."""
    cells = (cell for line in lines[2:] for cell in line.strip("|").split("|")[1:])
    return [float(re.sub("[ ,]", "", number).replace("−", "-")) for cell in cells
            for number in re.findall(rf"(?<![\w.]){NUMBER}", cell)]


def has_figures(part, lines):
    return bool(figures_of(lines)) if part.startswith("table") else bool(MEASURED.search(" ".join(lines)))


def missing(figures, text, differs):
    """Those that the text does not have."""
    printed = [float(number.replace("−", "-")) for number in re.findall(r"(?<![\w.])[-−]?\d+(?:\.\d+)?(?:e-?\d+)?", text)]
    return [figure for figure in figures
            if not any(abs(figure - each) <= differs * abs(figure) + 1e-9 for each in printed)]


def read_rows(path):
    """Raises ValueError that says which line is wrong."""
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.reader(file, delimiter="\t")
        if next(reader) != COLUMNS:
            raise ValueError(f"{path}:1: the columns are to be {', '.join(COLUMNS)}")
        rows = []
        for row in reader:
            if len(row) != len(COLUMNS):
                raise ValueError(f"{path}:{reader.line_num}: {len(row)} columns, not {len(COLUMNS)}")
            rows.append(dict(zip(COLUMNS, row)))
    return rows


def is_command(command, source):
    """Whether what it names is there: a script, a benchmark or a test."""
    for name in re.findall(r"\b(?:tests|docs|examples)/[\w./-]+\.(?:py|sh)", command):
        if not (source / name).exists():
            return False
    if found := re.search(r"build/(tests/\w+)/test_\w+ (test_\w+\.cpp)", command):
        return (source / found[1] / found[2]).exists()
    if found := re.search(r"spidar-bench (\w+)", command):
        return f'{{"{found[1]}",' in (source / "tests/bench/main.cpp").read_text(encoding="utf-8")
    if found := re.search(r"meson test -C build (?:--suite )?(\w+)", command):
        return any(f"'{found[1]}'" in file.read_text(encoding="utf-8") for file in (source / "tests").rglob("meson.build"))
    return bool(command)


def check(pages, rows, source, results=None):
    """What is wrong. `pages`: their texts by name; `results`: a folder."""
    places = {(page, heading, part): lines for page, text in pages.items() for heading, part, lines in parts_of(text)}
    known = {(row["page"], row["heading"], row["part"]) for row in rows}
    for place in sorted(known - places.keys()):
        if place[1:] != ("*", "*") or place[0] not in pages:
            yield f"figures.tsv: there is no {place[2]} below \"{place[1]}\" in {place[0]}"
    for place, lines in places.items():
        if not known & {place, (place[0], "*", "*")} and has_figures(place[2], lines):
            yield f"{place[0]}: the {place[2]} below \"{place[1]}\" has figures, and no row in figures.tsv says what prints them"
    for row in rows:
        place = row["page"], row["heading"], row["part"]
        if not is_command(row["command"], source):
            yield f"figures.tsv: {place}: there is no \"{row['command']}\"; \"-\" stands for no command"
        if row["command"] == "-" and not row["note"].startswith(NOT_MEASURED):
            yield f"figures.tsv: {place}: has no command, and its note does not begin with {', '.join(NOT_MEASURED)}"
        if row["differs"] == "-" or place not in places:
            continue
        differs, _, chosen = row["differs"].partition(": ")
        figures = [float(each) for each in chosen.split()]
        for figure in missing(figures, " ".join(places[place]), 0):
            yield f"figures.tsv: {figure:g} is not below \"{row['heading']}\" in {row['page']}"
        if results is None:
            continue
        file = Path(results, row["name"] + ".txt")
        if not file.exists():
            yield f"{file} is missing: tests/bench/results.sh writes it"
            continue
        for figure in missing(figures or figures_of(places[place]), file.read_text(encoding="utf-8"), float(differs)):
            yield f"{row['page']}: {figure:g} below \"{row['heading']}\" is not in {file}"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    names = ["README.md", *(str(page.relative_to(source)) for page in sorted((source / "docs").rglob("*.md")))]
    pages = {name: (source / name).read_text(encoding="utf-8") for name in names}
    wrong = list(check(pages, read_rows(TABLE), source, sys.argv[2] if len(sys.argv) > 2 else None))
    print("\n".join(wrong) if wrong else f"{len(pages)} pages, all figures have a command")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
