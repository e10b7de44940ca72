#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Counts the test cases of meson builds: summary.py BUILD... prints failed and skipped tests with the
reasons, and as its last line `N passed, N failed, N skipped`. Exits with an error when a test failed.

`--failed WHAT` counts a check that is not a meson test and failed, `--passed WHAT` one that passed.
`--log NAME` reads what `meson test --logbase NAME` wrote. What the log NAME-alone has, if there is
one, counts instead: tests that ran again. They are counted apart, and above `--most-again` of them, 1 by default, each
counts as failed: a test that needs to be alone is a fault of the test. `--list-failed` prints the names of the test
programs that failed, and nothing else; `--failures` a line for each test that did, with the reason behind a tab."""

import argparse
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def case_result(case):
    """("passed" | "failed" | "skipped", reason) of a GoogleTest case."""
    for tag, result in (("failure", "failed"), ("error", "failed"), ("skipped", "skipped")):
        found = case.find(tag)
        if found is not None:
            # "file:line", then the message
            return result, " ".join((found.get("message") or "").splitlines()[1:])
    return ("skipped", "disabled") if case.get("status") == "notrun" else ("passed", "")


def gtest_cases(log):
    """Test cases by test program: those that GoogleTest has reported one by one."""
    cases = {}
    text = Path(f"{log}.junit.xml").read_text(errors="replace")
    # Colours of what a test printed are no XML; meson writes them all the same.
    root = ElementTree.fromstring(re.sub("[\x00-\x08\x0b\x0c\x0e-\x1f]", "", text))
    for suite in root.findall("testsuite"):
        for case in suite.findall("testcase"):
            # Meson names such a suite project.program.suite, with "suites / " before the program.
            program, dot, name = suite.get("name").rpartition("." + case.get("classname"))
            if dot and not name:
                cases.setdefault(program.partition(".")[2].split(" / ")[-1], []).append(case)
    return cases


def runs_of(log):
    """What meson says of each test program. In its name, which only in whole is that of one test, project and suites
    come first."""
    with open(f"{log}.json", encoding="utf-8") as lines:
        return [json.loads(line) for line in lines]


def program_of(run):
    return run["name"].split(" / ")[-1]


def has_failed(run):
    return run["result"] not in ("OK", "EXPECTEDFAIL", "SKIP")


def results_of(log, without=()):
    """Yields (name, result, reason) for all in a log of meson's, LOG.json and LOG.junit.xml."""
    cases_of = gtest_cases(log)
    for run in runs_of(log):
        if run["name"] in without:
            continue
        program = program_of(run)
        failed = False
        for case in cases_of.get(program, []):
            result, reason = case_result(case)
            failed |= result == "failed"
            yield f"{program} {case.get('classname')}.{case.get('name')}", result, reason
        # A program without cases, or one that failed though its cases passed: by a leak, for instance.
        if run["result"] == "SKIP":
            yield program, "skipped", (run["stdout"] or "").strip().split("\n")[-1]
        elif not has_failed(run):
            if program not in cases_of:
                yield program, "passed", ""
        elif not failed:
            yield program, "failed", f"{run['result']}, exit status {run['returncode']}"


def results_with_again(log):
    """The results of a build: those of tests that ran again, alone, instead of their first ones."""
    alone = f"{log}-alone"
    again = runs_of(alone) if Path(f"{alone}.json").exists() else []
    yield from results_of(log, {run["name"] for run in again})
    if again:
        yield from results_of(alone)
    failed_before = {run["name"] for run in runs_of(log) if has_failed(run)}
    for run in again:
        if run["name"] in failed_before and not has_failed(run):
            yield program_of(run), "passed only alone", ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--passed", action="append", default=[])
    parser.add_argument("--failed", action="append", default=[])
    parser.add_argument("--log", default="testlog")
    parser.add_argument("--most-again", type=int, default=1)
    parser.add_argument("--list-failed", action="store_true")
    parser.add_argument("--failures", action="store_true")
    parser.add_argument("builds", nargs="*")
    arguments = parser.parse_args()

    if arguments.list_failed:
        for build in arguments.builds:
            for run in runs_of(Path(build) / "meson-logs" / arguments.log):
                if has_failed(run):
                    print(program_of(run))
        return

    if arguments.failures:
        for build in arguments.builds:
            for name, result, reason in results_of(Path(build) / "meson-logs" / arguments.log):
                if result == "failed":
                    print(name, reason, sep="\t")
        return

    counts = Counter(passed=len(arguments.passed), failed=len(arguments.failed))
    notes = [("failed", what, "") for what in arguments.failed]
    for build in arguments.builds:
        for name, result, reason in results_with_again(Path(build) / "meson-logs" / arguments.log):
            counts[result] += 1
            if result != "passed":
                notes.append((result, f"{build}/ {name}", f": {reason}" if reason else ""))
    if counts["passed only alone"] > arguments.most_again:
        counts["failed"] += counts["passed only alone"]
    for result, name, reason in sorted(notes, key=lambda note: note[0], reverse=True):
        print(f"{result}: {name}{reason}")
    if counts["passed only alone"]:
        print(f"{counts['passed only alone']} passed only alone, of which {arguments.most_again} may be")
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    sys.exit(1 if counts["failed"] else 0)


if __name__ == "__main__":
    main()
