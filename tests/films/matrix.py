#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays and records films of every kind that ffmpeg makes, and prints what was tried:

    matrix.py CORPUS SPIDARTRACK SPIDAR_FEEL [--product DIMENSION,...] [--only TEXT] [--keep FOLDER] [--jobs N]

In the films, every pair of values of dimensions.py occurs; with --product, every combination of the values of these
dimensions, too. --only takes the films whose description contains TEXT, --keep keeps what was written for them.
CORPUS is a folder for the films, which are made once. The exit status is 77 if what it needs is not installed."""
import argparse
import collections
import concurrent.futures
import os
import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path

import corpus
import dimensions
from checks import CHECKS, NEEDED, Wrong
from known_failures import KNOWN
from trial import Trial

SKIPPED = 77


def missing():
    for program, package in (("ffmpeg", "ffmpeg"), ("ffprobe", "ffmpeg"), ("gnuplot", "gnuplot-nox"),
                             ("gst-play-1.0", "gstreamer1.0-plugins-base-apps")):
        if not shutil.which(program):
            return f"{program} is not installed (package {package})"
    try:
        import gi
        gi.require_version("Gst", "1.0")
    except (ImportError, ValueError) as error:
        return f"{error} (packages python3-gi, gir1.2-gstreamer-1.0)"
    return None


def known_reason(check, kind, message):
    return next((reason for name, concerns, words, reason in KNOWN
                 if name == check and concerns(kind) and words in message), None)


def try_film(film, other, programs, keep):
    """What each check says: None if it holds, False if it was left out, else a sentence."""
    results = {}
    with tempfile.TemporaryDirectory(prefix="films-", ignore_cleanup_errors=True) as folder:
        trial = Trial(film, other, Path(folder), programs)
        try:
            trial.look()
        except (RuntimeError, OSError) as error:
            return {"pictures": str(error)}
        for check in CHECKS:
            name = check.__name__
            if name in results:
                continue
            if any(results.get(need.__name__, None) is not None for need in NEEDED.get(check, ())):
                results[name] = False
                continue
            try:
                results[name] = check(trial)
            except (Wrong, RuntimeError, KeyError, OSError, ValueError) as error:
                results[name] = str(error) if isinstance(error, (Wrong, RuntimeError)) else repr(error)
        if keep:
            shutil.copytree(folder, Path(keep) / film.path.parent.name, dirs_exist_ok=True)
    return results


def other_of(position, kinds):
    """The position of a film with other pictures at the same times, if possible in the same container."""
    kind = kinds[position]
    return max(range((position + 1) % 2, len(kinds), 2),  # every other film is mirrored
               key=lambda i: [kinds[i][name] == kind[name] for name in ("times", "container", "pictures")])


def printable(text):
    return text.encode(errors="backslashreplace").decode()


class Table:
    def __init__(self):
        self.lines = collections.defaultdict(collections.Counter)
        self.known, self.failures = collections.Counter(), 0

    def add(self, film, results):
        for check, result in results.items():
            reason = result and known_reason(check, film.kind, result)
            outcome = "left out" if result is False else "good" if result is None else "known" if reason else "failed"
            for line in [("check", check), *film.kind.items()]:
                self.lines[line][outcome] += 1
            if outcome == "known":
                self.known[check, reason] += 1
            elif outcome == "failed":
                self.failures += 1
                print(printable(f"FAILED: {check}: {film}\n    {film.path}\n    {result}"), flush=True)
        for line in film.kind.items():
            self.lines[line]["films"] += 1

    def print(self):
        print(f"\n{'':38} films  good  known  failed  left out")
        for group in ("check", *dimensions.DIMENSIONS):
            for (name, value), count in self.lines.items():
                if name == group:
                    print(f"{name + ': ' + value:38} {count['films'] or '':>5} {count['good']:>5} {count['known']:>6} "
                          f"{count['failed']:>7} {count['left out']:>9}")
        for (check, reason), count in self.known.items():
            print(f"known: {check}, {count} films: {reason}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("corpus", "spidartrack", "spidar_feel"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--product", default="")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep")
    parser.add_argument("--jobs", type=int, default=2 * (os.cpu_count() or 1))
    options = parser.parse_args()
    if reason := missing():
        print(f"skipped: {reason}")
        return SKIPPED
    programs = {"spidartrack": options.spidartrack.resolve(), "spidar-feel": options.spidar_feel.resolve()}
    names = [name for name in options.product.split(",") if name]
    kinds = dimensions.cover(dimensions.product(names) if names else [])
    options.corpus.mkdir(parents=True, exist_ok=True)
    began = time.monotonic()
    table, lock = Table(), threading.Lock()
    chosen = [i for i, kind in enumerate(kinds) if options.only in ", ".join(kind.values())]
    needed = sorted({*chosen, *(other_of(i, kinds) for i in chosen)})
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        corpus.masters(options.corpus)
        made = pool.map(lambda i: corpus.make(kinds[i], i % 2 == 1, options.corpus), needed)
        films = dict(zip(needed, made))
        print(f"{len(films)} films, made in {time.monotonic() - began:.0f} s", flush=True)

        def work(i):
            results = try_film(films[i], films[other_of(i, kinds)], programs, options.keep)
            with lock:
                table.add(films[i], results)

        list(pool.map(work, chosen))
    table.print()
    for name, _, _, reason in KNOWN:
        if (name, reason) not in table.known and not options.only:
            print(f"not known any more, remove it from known_failures.py: {name}: {reason}")
    print(f"{len(chosen)} films in {time.monotonic() - began:.0f} s, {table.failures} failures")
    return 1 if table.failures else 0


if __name__ == "__main__":
    sys.exit(main())
