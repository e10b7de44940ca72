#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Follows the links of README.md, CONTRIBUTING.md, CHANGELOG.md, SECURITY.md, tests/README.md and docs/ within the
source tree.

check_links.py SOURCE: a link must name a file of SOURCE, and after a # a heading of that page; so must a path
in `code` that begins with the name of a folder; `core/x/y` and `x/y` may stand for y.h and y.cpp there. The
sources must have every name in the `code` of docs/extend.md. Every page of docs/ must be linked from
docs/README.md, which is the table of contents of the site; every picture must have a text for those who do not
see it. The page on troubleshooting must have every reason why nothing is felt. A page of the site links no page that
the site has not (`PAGES` in docs/conf.py): Sphinx refuses that. Addresses on the net are not fetched."""

import ast
import re
import sys
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")

# In code; of these, a path begins with the name of a folder.
PATH = re.compile(r"`(\w[\w.-]*/[\w./-]*[\w/])`")
# A name of the source: `ForceBoard`, `GainController::force_N()`, `OnTransport<ForceBoard>`.
NAME = re.compile(r"`([A-Za-z_]\w*(?:::\w+)*(?:<\w+>)?(?:\(\))?)`")
TOP = ("core", "docs", "examples", "plugin", "spidar", "tests")


def without_code(text):
    """The lines of a page, with blocks of code and `code` left out."""
    lines = [("" if line.startswith("    ") else line) for line in text.split("\n")]
    return re.sub(r"`[^`\n]*`", "", "\n".join(lines))


def anchors(text):
    """As GitHub and MyST make them of headings."""
    found = set()
    for line in text.split("\n"):
        if heading := re.match(r"#+ +(.*)", line):
            slug = re.sub(r"[^\w\- ]", "", heading[1].strip().lower()).replace(" ", "-")
            number = 1
            unique = slug
            while unique in found:
                unique, number = f"{slug}-{number}", number + 1
            found.add(unique)
    return found


def main():
    source = Path(sys.argv[1]).resolve()
    docs = source / "docs"
    pages = [source / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "tests/README.md")] + sorted(docs.rglob("*.md"))
    texts = {page: page.read_text(encoding="utf-8") for page in pages}
    listed = re.search(r"^PAGES = (\[.*?\])", (docs / "conf.py").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]
    site = {source / name for name in ast.literal_eval(listed)} | {page for page in pages if docs in page.parents}
    wrong, links, in_contents = [], 0, {docs / "README.md"}
    files = {str(path.relative_to(source)) for top in TOP for path in (source / top).rglob("*")
             if "__pycache__" not in path.parts}
    files |= {str(Path(file).with_suffix("")) for file in files}
    folders = {part for file in files for part in Path(file).parts[:-1]}

    words = {word for top in TOP for path in (source / top).rglob("*") if path.suffix in (".h", ".cpp", ".build", ".py")
             for word in re.findall(r"\w+", path.read_text(encoding="utf-8"))}
    names = [name for name in NAME.findall(texts[docs / "extend.md"]) if not name.startswith(("yours", "pipelines_"))]
    wrong += [f"docs/extend.md: {name}: the sources have no such name" for name in names
              if not set(re.findall(r"\w+", name)) <= words]
    # The sentences of plugin/reasons, after the first, which is that something is felt.
    table = (source / "plugin/reasons/no_force.cpp").read_text(encoding="utf-8")
    _, *reasons = re.findall(r'{NoForceReason::\w+,\s*"([\w-]+)"', table)
    [advice] = docs.rglob("troubleshooting.md")
    wrong += [f"{advice.relative_to(source)}: {reason}: is not explained" for reason in reasons
              if f"`{reason}`" not in texts[advice]]

    def is_there(path, page):
        """As it is, beside the page, or the end of a path, as `layers/regions` is."""
        path = path.rstrip("/")
        return (page.parent / path).exists() or path in files or any(file.endswith("/" + path) for file in files)

    for page, text in texts.items():
        name = page.relative_to(source)
        if page.name != "CHANGELOG.md":
            wrong += [f"{name}: {path}: there is no such file" for path in PATH.findall(text)
                      if path.split("/")[0] in folders and not is_there(path, page)]
        for picture, words, target in LINK.findall(without_code(text)):
            if re.match(r"[a-z]+:", target):
                continue
            links += 1
            path, _, anchor = unquote(target).partition("#")
            file = (page.parent / path).resolve() if path else page
            if page == docs / "README.md":
                in_contents.add(file)
            if not file.is_relative_to(source) or not file.exists():
                wrong.append(f"{name}: {target}: there is no such file")
            elif file.suffix == ".md" and page in site and file not in site:
                wrong.append(f"{name}: {target}: the site has no such page; name the file in `code`")
            elif anchor and anchor not in anchors(texts.get(file, "")):
                wrong.append(f"{name}: {target}: {file.name} has no such heading")
            if picture and not words.strip():
                wrong.append(f"{name}: {target}: the picture has no text")
    wrong += [f"docs/README.md: no link to {page.relative_to(docs)}" for page in pages
              if docs in page.parents and page not in in_contents]
    print("\n".join(wrong + [f"{links} links in {len(pages)} pages, {len(wrong)} wrong"]))
    return 1 if wrong or not links else 0


if __name__ == "__main__":
    sys.exit(main())
