# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Configuration of Sphinx; `meson compile -C build docs` runs it (docs/site.sh). The pages are the Markdown files of
docs/ and some others (`PAGES`) as they are. Nothing is loaded from the net when the site is read."""

import importlib.util
import posixpath
import re
from pathlib import Path

from sphinx.errors import ConfigError

ROOT = Path(__file__).parent.parent

if importlib.util.find_spec("myst_parser") is None:
    raise ConfigError("the pages are Markdown: install MyST (Debian: python3-myst-parser)")

project = "gst-spidar"
author = "the gst-spidar authors"
copyright = "2026, the gst-spidar authors"  # noqa: A001
version = release = re.search(r"version: '(.*?)'", (ROOT / "meson.build").read_text(encoding="utf-8"))[1]

extensions = ["myst_parser"]
myst_heading_anchors = 4
root_doc = "docs/README"
PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "tests/README.md"]
include_patterns = ["docs/**", *PAGES]
# Sphinx need not walk through builds.
exclude_patterns = [entry.name for entry in ROOT.iterdir() if entry.name not in ("docs", "tests", *PAGES)]

html_theme = "furo" if importlib.util.find_spec("furo") else "alabaster"
html_title = f"gst-spidar {release}"
html_copy_source = False
html_show_sphinx = False

REFERENCE = '\n<p><a href="../api/index.html">Reference of the headers</a>, made by Doxygen.</p>\n'


def contents(page):
    """A tree of contents for each section of docs/README.md, from the pages that the section links."""
    trees = []
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        caption = section.split("\n", 1)[0]
        names = [posixpath.normpath(posixpath.join("docs", link)) for link in re.findall(r"\]\(([^)]+)\.md\)", section)]
        trees.append("\n".join(["```{toctree}", ":hidden:", f":caption: {caption}", "", *(f"/{n}" for n in names), "```"]))
    return "\n\n".join(trees)


def read(app, name, source):
    if name == root_doc:
        source[0] += REFERENCE + "\n" + contents(source[0]) + "\n"
    elif name == "README":
        source[0] = "---\norphan: true\n---\n" + source[0]  # other pages link to it, no table of contents does
    elif name == "docs/api":
        source[0] += REFERENCE


def setup(app):
    app.connect("source-read", read)
