#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Plays and records films of every kind that ffmpeg makes, and prints what was tried:

    matrix.py CORPUS SPIDARTRACK SPIDAR_FEEL [--meeting | --whole [DIMENSION,...]] [--only TEXT] [--keep FOLDER] [--jobs N]

In the films, every value of every dimension occurs, every pair of values of the dimensions that EVERYDAY names
(dimensions.py), with --meeting of those that MEETING names, and each film goes through one of the tools. With --whole,
every pair of values of all dimensions occurs, every combination of values of those that are given, and each film goes
through all tools. --only takes the films whose description contains TEXT,
--keep keeps what was written for them. CORPUS is a folder for the films, which are made once.

It fails when a check fails that known_failures.py does not know, or, with --meeting and the release of GStreamer that
this list is for, when an entry of it is needed no more. Up to five films that fail beside others are tried again alone. The exit
status is 77 if what it needs is not installed."""
import argparse
import collections
import concurrent.futures
import os
import queue
import resource
import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path

import corpus
import dimensions
from checks import CHECKS, NEEDED, Wrong
from known_failures import KNOWN, RARE, RELEASE
from trial import Player, Trial

SKIPPED = 77
MOST_AGAIN = 5  # more is no matter of a busy machine


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
    return next((reason for name, concerns, words, reason in KNOWN + RARE
                 if name == check and concerns(kind) and words in message), None)


def try_film(film, other, programs, player, all_tools, keep):
    """What each check says: None if it holds, False if it was left out, else a sentence."""
    results = {}
    with tempfile.TemporaryDirectory(prefix="films-", ignore_cleanup_errors=True) as folder:
        trial = Trial(film, other, Path(folder), programs, player)
        try:
            trial.look()
        except (RuntimeError, OSError) as error:
            return {"pictures": str(error)}
        for check in CHECKS:
            name = check.__name__
            if name in dimensions.TOOLS and not all_tools and name != film.kind["tool"]:
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


def processor_s():
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def printable(text):
    return text.encode(errors="backslashreplace").decode()


def fails(film, results):
    return any(result and not known_reason(check, film.kind, result) for check, result in results.items())


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
            for name, value in sorted(line for line in self.lines if line[0] == group):
                count = self.lines[name, value]
                print(f"{name + ': ' + value:38} {count['films'] or '':>5} {count['good']:>5} {count['known']:>6} "
                      f"{count['failed']:>7} {count['left out']:>9}")
        for (check, reason), count in sorted(self.known.items()):
            print(f"known: {check}, {count} films: {reason}")

    def look_for_stale(self):
        """Entries of known_failures.py that no film needs are failures, or only named with another GStreamer."""
        from gi.repository import Gst
        is_meant = Gst.version_string().startswith(f"GStreamer {RELEASE}.")
        for name, _, _, reason in KNOWN:
            if (name, reason) not in self.known:
                self.failures += is_meant
                print(f"{'FAILED' if is_meant else 'note'}: remove from known_failures.py what does not fail any more: "
                      f"{name}: {reason}")


class Maker:
    """Makes the films, once each, and says which ffmpeg cannot make."""

    def __init__(self, kinds, corpus_folder):
        self.kinds, self.folder, self.refused = kinds, corpus_folder, collections.Counter()
        corpus_folder.mkdir(parents=True, exist_ok=True)
        corpus.masters(corpus_folder)

    def make(self, i):
        """Nothing when ffmpeg has no encoder for it."""
        try:
            return corpus.make(self.kinds[i], i % 2 == 1, self.folder)
        except corpus.NoEncoder as missing:
            self.refused[str(missing)] += 1
            return None


def run(options, programs):
    """The number of failures."""
    if options.whole is not None:
        kinds = dimensions.whole([name for name in options.whole.split(",") if name])
    else:
        kinds = dimensions.meeting() if options.meeting else dimensions.every_day()
    began = time.monotonic()
    table, lock, players = Table(), threading.Lock(), queue.SimpleQueue()
    chosen = [i for i, kind in enumerate(kinds) if options.only in ", ".join(kind.values())]
    needed = sorted({*chosen, *(other_of(i, kinds) for i in chosen)})
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        maker = Maker(kinds, options.corpus)
        films = dict(zip(needed, pool.map(maker.make, needed)))
        print(f"{len(films)} films, made in {time.monotonic() - began:.0f} s, {processor_s():.0f} s of processor time",
              flush=True)
        for reason, count in maker.refused.items():
            print(f"{count} films are not made: {reason}")
        for _ in range(options.jobs):
            players.put(Player())

        def work(i, alone=False):
            film, other = films[i], films[other_of(i, kinds)]
            if not film or not other:
                return
            player = players.get()
            results = try_film(film, other, programs, player, options.whole is not None, options.keep)
            players.put(player)
            with lock:
                if not alone and len(again) < MOST_AGAIN and fails(film, results):
                    again.append(i)
                else:
                    table.add(film, results)

        again = []
        list(pool.map(work, chosen))
        for i in again:
            print(printable(f"fails beside other films, and is tried again alone: {films[i]}"), flush=True)
            work(i, alone=True)
    hangs = collections.Counter()
    for _ in range(options.jobs):
        player = players.get()
        player.close()
        hangs += player.hangs
    table.print()
    for player, count in hangs.items():
        print(f"{player} hung or showed nothing in {count} plays, which were repeated, or lost its end after all was "
              "seen and felt")
    if options.meeting and not options.only and not maker.refused:
        table.look_for_stale()
    print(f"{len(chosen)} films in {time.monotonic() - began:.0f} s, {processor_s():.0f} s of processor time, "
          f"{table.failures} failures")
    return table.failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("corpus", "spidartrack", "spidar_feel"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--meeting", action="store_true")
    parser.add_argument("--whole", nargs="?", const="")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep")
    parser.add_argument("--jobs", type=int, default=2 * (os.cpu_count() or 1))
    options = parser.parse_args()
    if reason := missing():
        print(f"skipped: {reason}")
        return SKIPPED
    return 1 if run(options, {"spidartrack": options.spidartrack.resolve(),
                              "spidar-feel": options.spidar_feel.resolve()}) else 0


if __name__ == "__main__":
    sys.exit(main())
