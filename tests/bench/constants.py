#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures what each constant of the analysis does on real films. constants.py [--only NAME,...] FOLDER... builds a copy
of the source in which a constant can be changed when the plugin is loaded, analyses the films of the FOLDERs, which are
those of real_films.py, with half and with double each constant, and prints two tables: how many constants there are of
each kind, and what each chosen one does. --only leaves all other constants out. Run it in the top folder of the source.
An hour for forty films on two processors.

A whole number is rounded up when it is halved. A value of which the films show exactly the same has the sign =."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from real_films import Tally, play, read_truth

LAYERS = ("core/field", "core/motion", "core/tracking")
AT_ONCE = 2
# Constants that nobody chose for the sake of the films, or that cannot be halved, by kind. All others are chosen.
KINDS = {
    "memory: how much is reserved, far more than is used": """
        dominant_object.kMostRivals field_points.kMostPoints motion_models.kMostDisplacements objects.kMostObjects
        regions.kMostRegions corner.kMostCornerBox_px""",
    "arithmetic: fixed point, lanes, guards of a division": """
        block_field.kMost_px block_kernels.kFractionOne combing.kLines corner.kTwice field_picture.kNinth
        layer_evidence.kLeast_px_s luma_row.kLanes luma_words.kBytes motion_estimator.kFirstBlockId motion_models.kOnePlace_px
        motion_models.kSteps         motion_models.kSmall motion_models.kUnit_px motion_models.kModelKinds padded_image.kCacheLine
        padded_image.kRowsAhead regions.kNoRegion window_kernels.kPixelOne window_kernels.kDerivativeOne
        window_kernels.kDifferenceOne window_kernels.kGainOne window_match.kMostGain""",
    "derived: computed from others, or a number of mathematics or of a cited paper": """
        background.kMostObject cadence.kSameInterval moving_blocks.kLeastLasting regions.kAlikeShare
        repeated_picture.kShareWhenDue robust_fit.kMostCost robust_fit.kMostTries
        background.kLost background.kTexturedShare block_kernels.kBlockArea_px block_kernels.kHalf
        block_search.kBlockReach_px block_search.kMostDeviation_px block_search.kFarthest_px block_search.kNearest_px
        block_search.kMostSteps burned_in.kLeastPixels burned_in.kExactShareElsewhere burned_in.kInPlace_px
        burned_in.kLasting burned_in.kMostScore burned_in.kBeside_px cadence.kEnough cadence.kLongest_ns combing.kEvery
        combing.kSame_grey corner.kPixels corner.kTensorBlock_px corner.kMostBlocks corner.kHalf_px
        luma_neighbourhood.kBefore_px luma_neighbourhood.kRight_px luma_neighbourhood.kBelow_px
        luma_neighbourhood.kMostWhole_px luma_neighbourhood.kWidest_px luma_neighbourhood.kHighest_px
        motion_estimator.kLeastVoteTexture error_bound.kAround_px error_bound.kMedianVariance
        field_picture.kLeastCoarseSide_px fine_window.kPixels fine_window.kCoarsePixels margins.kMostOfSide
        moving_object.kErrorSigmas padded_image.kHalf padded_image.kBlock window_kernels.kStride window_match.kLeastGain
        window_match.kPixels window_match.kScale""",
    "sizes that the code is compiled for: blocks, windows, rings": """
        block_kernels.kBlock_px cadence.kPictures corner.kCornerWindow_px corner.kCornerStep_px field_picture.kCoarser
        fine_window.kPointWindow_px luma_neighbourhood.kWindow_px luma_neighbourhood.kMostReach_px padded_image.kPad_px
        repeated_picture.kComparedBlock_px repeated_picture.kFrames repeated_picture.kChangedBlocks""",
    "the paper's method, which `motion=object` does not use": """
        opencv_tracker.kThinnedOut opencv_tracker.kSelectionInterval opencv_tracker.kFoundAfterCut
        opencv_tracker.kMinForCut point_flow.kWindow_px point_flow.kMaxLevel point_flow.kMinMeanGradient
        point_flow.kMinEigenvalue point_flow.kMaxReturn_px point_flow.kRounding point_flow.kHalf
        point_flow.kWithDerivatives point_flow.kReuseInput point_selection.kNeighbourhood_px point_selection.kSobel_px
        point_selection.kMinWeakestGradient point_selection.kMinResponse tracker.kMostFeatures
        tracker.kReferenceHeight_px tracker.kMinSide_px luma_reduce.kReducedSide_px""",
}
DEFINITION = re.compile(r"^(?P<indent> *)(?P<static>static )?constexpr (?P<type>auto|bool|double|float|int|int16_t|"
                        r"int64_t|size_t|uint32_t|unsigned) (?P<name>k[A-Z]\w*) = (?P<value>[^;]+);"
                        r"(?: *//+<? *(?P<note>.*))?$")
TUNED = """#pragma once
#include <cstdlib>
inline double tuned(const char* name, double value) {
  const char* other = std::getenv(name);
  return other ? std::strtod(other, nullptr) : value;
}
"""


class Constant:
    def __init__(self, file, found, comment):
        self.file, self.name, self.type, self.text = file, found["name"], found["type"], found["value"]
        self.comment = " ".join(filter(None, [comment, found["note"]]))
        self.key = f"{file.stem}.{self.name}"
        self.variable = f"SPIDAR_K_{file.stem}_{self.name}"
        self.kind = next((kind for kind, keys in KINDS.items() if self.key in keys.split()), None)

    def needs(self):
        """Names of the constants that this one is computed from."""
        return set(re.findall(r"k[A-Z]\w*", self.text))

    def value(self, everything):
        """Of the few expressions that there are: numbers, + - * / and other constants."""
        text = re.sub(r"\b(\d[\d.]*(?:e-?\d+)?)[fu]\b", r"\1", self.text.replace("'", ""))
        text = re.sub(r"(?:\w+::)?(k[A-Z]\w*)", lambda m: str(everything[m[1]].value(everything)), text)
        if not re.fullmatch(r"[-+*/(). \de]+", text):
            sys.exit(f"constants.py: {self.file} defines {self.name} as {self.text}, which is no number: name its kind")
        value = eval(text)  # digits and signs only
        return value if self.type in ("double", "float") else int(value)

    def scaled(self, value, factor):
        return value * factor if self.type in ("double", "float") else -int(-value * factor // 1)


def read(source):
    """All constants, in the order of the files. A comment is of all the constants that follow it directly."""
    constants = []
    for file in sorted(f for layer in LAYERS for f in (source / layer).iterdir() if f.suffix in (".h", ".cpp")):
        comment, lines, after_comment = "", file.read_text().splitlines(), False
        for line in lines:
            found = DEFINITION.match(line)
            if found:
                constants.append(Constant(file, found, comment))
            elif (text := line.strip()).startswith("//"):
                comment = (comment + " " if after_comment else "") + text.lstrip("/< ")
            else:
                comment = ""
            after_comment = not found and line.strip().startswith("//")
    return constants


def make_tunable(copy, constants):
    """Rewrites the chosen ones, and makes of what is computed from them no constants for the compiler."""
    tuned = {c.name for c in constants if c.kind is None}
    for _ in constants:  # what is computed from what is computed from them
        tuned |= {c.name for c in constants if c.needs() & tuned}
    for file in {c.file for c in constants}:
        keys = {c.name: c for c in constants if c.file == file}

        def rewrite(found):
            name, kind = found["name"], found["type"]
            storage = found["static"] and "inline static" or (file.suffix == ".h" and "inline") or "static"
            if keys[name].kind is not None:
                if keys[name].needs() & tuned:
                    return found[0].replace("static constexpr", "inline static const").replace("constexpr", "const")
                return found[0]
            value = f'static_cast<{kind}>(tuned("{keys[name].variable}", {found["value"]}))'
            return f"{found['indent']}{storage} const {kind} {name} = {value};"

        target = copy / file
        target.write_text("\n".join(DEFINITION.sub(rewrite, line) for line in target.read_text().split("\n")))


def build(copy, constants):
    make_tunable(copy, constants)
    (copy / "tuned.h").write_text(TUNED)
    target = copy / "build"
    options = ["-Dunity=on", "-Dtests=false", "-Dapps=false", "-Dbenchmarks=disabled", "-Dwindow=disabled", "-Doptimization=2",
               "-Ddebug=false", f"-Dcpp_args=-include{copy / 'tuned.h'}"]
    for command in (["meson", "setup", *options, target, copy],
                    ["ninja", f"-j{AT_ONCE}", "-C", target, "plugin/libgstspidar.so"]):
        subprocess.run(command, check=True, stdout=sys.stderr)
    return target


def decode(film, folder):
    """The film without compression, so that it is decoded only once."""
    raw = folder / f"{len(list(folder.iterdir()))}.mkv"
    subprocess.run(["gst-launch-1.0", "-q", "filesrc", f"location={film}", "!", "decodebin", "!", "videoconvert", "!",
                    "matroskamux", "!", "filesink", f"location={raw}"], check=True, stdout=sys.stderr)
    return raw


class Films:
    """Every film of the folders, and what is felt in it."""

    def __init__(self, build_folder, raw, folders):
        self.build, self.folders, self.films, self.default = build_folder, folders, [], None
        for folder in folders:
            for film in sorted(f for f in folder.iterdir() if f.suffix not in (".csv", ".md", ".txt", ".py")):
                truth = film.with_suffix(".csv")
                self.films.append((folder, decode(film, raw), read_truth(truth) if truth.exists() else None))

    def measure(self, variable=None, value=None):
        """right/wrong/false of all the films, and of those of each folder; = for the same as with nothing changed."""
        if variable:
            os.environ[variable] = str(value)
        with ThreadPoolExecutor(AT_ONCE) as pool:
            found = list(pool.map(lambda film: play(self.build, film[1], []), self.films))
        os.environ.pop(variable or "", None)
        if self.default is None:
            self.default = found
        elif found == self.default:
            return "=", ""
        tallies = {folder: Tally() for folder in [None, *self.folders]}
        for (folder, _, truth), one in zip(self.films, found):
            for which in (None, folder):
                tallies[which].add(*one, truth)
        figures = ["/".join(tally.row("").split(" | ")[k].strip("| ") for k in (1, 2, 4)) for tally in tallies.values()]
        return figures[0], "  ".join(figures[1:])


def number(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def row(c, value, found, above):
    comment = "as above" if c.comment and c.comment == above else c.comment
    return f"| `{c.key}` | {number(value)} | {found[0]} | {found[1]} | {comment} |"


def compare(films, constants, chosen):
    """A row of the table for each of the chosen."""
    everything = {c.name: c for c in constants}
    above = ""
    for c in chosen:
        value, found = c.value(everything), []
        for factor in (0.5, 2):
            other = c.scaled(value, factor)
            figures, apart = films.measure(c.variable, other) if other != value else ("", "")
            found.append(figures)
            print(f"{c.key} {number(value)} -> {number(other)}: {figures}  {apart}", file=sys.stderr, flush=True)
        yield row(c, value, found, above)
        above = c.comment


def kinds(constants):
    chosen = sum(c.kind is None for c in constants)
    counts = [f"| {kind} | {sum(c.kind == kind for c in constants)} |" for kind in KINDS]
    return ["| kind | number |", "|---|---|", f"| chosen | {chosen} |", *counts]


def main():
    arguments, only = sys.argv[1:], None
    if arguments[:1] == ["--only"] and len(arguments) > 1:
        only, arguments = arguments[1].split(","), arguments[2:]
    folders = [Path(a) for a in arguments]
    if not folders or not all(f.is_dir() for f in folders):
        sys.exit("usage: constants.py [--only NAME,...] FOLDER..., folders of films with the true motion beside them")
    constants = read(Path())
    chosen = [c for c in constants if c.kind is None and (only is None or c.name in only or c.key in only)]
    if not chosen:
        sys.exit(f"constants.py: none of {', '.join(only)} is a chosen constant of {', '.join(LAYERS)}")
    with tempfile.TemporaryDirectory() as scratch:
        copy, raw = Path(scratch) / "source", Path(scratch) / "films"
        shutil.copytree(".", copy, ignore=shutil.ignore_patterns("build*", ".git"))
        raw.mkdir()
        films = Films(build(copy, constants), raw, folders)
        default, apart = films.measure()
        print(f"default {default}  {apart}", file=sys.stderr, flush=True)
        if only is None:
            print("\n".join(kinds(constants)) + "\n")
        print(f"With nothing changed: {default}.\n\n| constant | value | half | double | what it is |\n|---|---|---|---|---|")
        for line in compare(films, constants, chosen):
            print(line, flush=True)


if __name__ == "__main__":
    main()
