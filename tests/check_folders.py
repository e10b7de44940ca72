#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Reads the #include lines: a layer includes only those below it, and in each layer the folders form
no circle, neither each by itself nor with the folders in them. Prints every #include of a layer above,
and those of the shortest circle."""

import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
BELOW = {"core": [], "spidar": ["core"], "plugin": ["core", "spidar"]}


def includes():
    """(file, included file) of every #include of another folder."""
    for layer in BELOW:
        for file in sorted((TOP / layer).rglob("*.*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            for name in re.findall(r'^#include "(.+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
                if (TOP / name).parent != file.parent:
                    yield file.relative_to(TOP), Path(name)


def circle(arrows):
    """The folders of the shortest circle, the first one also at the end; empty when there is none."""
    shortest = []
    for start in sorted(arrows):
        before, waiting = {}, [start]
        while waiting and start not in before:
            folder = waiting.pop(0)
            for other in sorted(arrows.get(folder, ())):
                if other not in before:
                    before[other] = folder
                    waiting.append(other)
        if start in before:
            way = [start, before[start]]
            while way[-1] != start:
                way.append(before[way[-1]])
            if not shortest or len(way) < len(shortest):
                shortest = way[::-1]
    return shortest


def with_their_folders(folder, other):
    """The two folders beside each other in which they are; None when one is in the other."""
    for depth, (part, other_part) in enumerate(zip(folder.parts, other.parts), start=1):
        if part != other_part:
            return Path(*folder.parts[:depth]), Path(*other.parts[:depth])
    return None


def faults():
    arrows = {}  # folder: {folder: an #include}
    wide_arrows = {}  # the same of folders with all that is in them
    for file, included in includes():
        layer, other = file.parts[0], included.parts[0]
        if other != layer and other not in BELOW[layer]:
            yield f"{file} includes {included}, but {layer}/ may use {' and '.join(BELOW[layer]) or 'no other layer'}"
        arrows.setdefault(file.parent, {})[included.parent] = f"{file} includes {included}"
        if wide := with_their_folders(file.parent, included.parent):
            wide_arrows.setdefault(wide[0], {})[wide[1]] = f"{file} includes {included}"
    for between in (arrows, wide_arrows):
        way = circle(between)
        for folder, other in zip(way, way[1:]):
            yield f"in a circle of folders: {between[folder][other]}"


found = list(faults())
print("\n".join(found) or "no circle of folders")
sys.exit(1 if found else 0)
