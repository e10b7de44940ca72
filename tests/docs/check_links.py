#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Follows the links of README.md, CONTRIBUTING.md, CHANGELOG.md, SECURITY.md, tests/README.md and docs/ within the
source tree.

check_links.py SOURCE: a link must name a file of SOURCE, and after a # a heading of that page; so must a path in
`code` that looks like a source file's or folder's; `core/x/y` may stand for y.h and
y.cpp. Every page of docs/ must be linked from docs/README.md, which is the table of contents of the site; every picture
must have a text for those who do not see it. Addresses on the net are not fetched."""

import re
import sys
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")

SOURCE_FILE = re.compile(r"`((?:core|docs|examples|plugin|spidar|tests)/[\w./-]*[\w/])`")


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
    wrong, links, in_contents = [], 0, {docs / "README.md"}
    for page, text in texts.items():
        name = page.relative_to(source)
        if page.name != "CHANGELOG.md":
            wrong += [f"{name}: {path}: there is no such file" for path in SOURCE_FILE.findall(text)
                      if not any((base / path).exists() or list((base / path).parent.glob(f"{(base / path).name}.*"))
                                 for base in (source, page.parent))]
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
