#!/usr/bin/env python3
"""Counts the test cases of meson builds: summary.py BUILD... prints what failed and what was skipped
and why, and as its last line `N passed, N failed, N skipped`. Fails when a test did.

`--failed WHAT` counts something that is no meson test and went wrong, `--passed WHAT` one that went
well."""

import argparse
import json
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def case_result(case):
    """("passed" | "failed" | "skipped", reason) of a JUnit test case."""
    for tag, result in (("failure", "failed"), ("error", "failed"), ("skipped", "skipped")):
        found = case.find(tag)
        if found is not None:
            reason = found.get("message") or found.text or case.findtext("system-out") or ""
            lines = reason.strip().splitlines()
            # GoogleTest puts "file:line" before the message of a skip.
            return result, lines[-1] if lines else "no reason given"
    if case.get("status") == "notrun":
        return "skipped", "disabled"
    return "passed", ""


def cases_of(build):
    """Yields (name, result, reason) for every test case that ran in a build folder."""
    logs = Path(build) / "meson-logs"
    suites = ElementTree.parse(logs / "testlog.junit.xml").getroot().findall("testsuite")
    failed_programs = set()
    for suite in suites:
        for case in suite.findall("testcase"):
            result, reason = case_result(case)
            if result == "failed":
                failed_programs.update((suite.get("name").split(".")[1:2] or [case.get("name")]))
            name = case.get("name")
            if case.get("classname") and case.get("classname") != suite.get("name"):
                name = f"{case.get('classname')}.{name}"
            yield name, result, reason

    # A program whose cases all passed can still fail, by a leak found when it ends for instance.
    with open(logs / "testlog.json", encoding="utf-8") as lines:
        for run in map(json.loads, lines):
            program = run["name"].split(" / ")[-1]
            if run["result"] in ("FAIL", "ERROR", "TIMEOUT", "INTERRUPT"):
                if program not in failed_programs:
                    yield program, "failed", f"{run['result']}, exit status {run['returncode']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--passed", action="append", default=[])
    parser.add_argument("--failed", action="append", default=[])
    parser.add_argument("builds", nargs="*")
    arguments = parser.parse_args()

    counts = Counter(passed=len(arguments.passed), failed=len(arguments.failed))
    notes = [("failed", what, "") for what in arguments.failed]
    for build in arguments.builds:
        for name, result, reason in cases_of(build):
            counts[result] += 1
            if result != "passed":
                notes.append((result, f"{build}: {name}", f": {reason}" if reason else ""))
    for result, name, reason in sorted(notes, key=lambda note: note[0], reverse=True):
        print(f"{result}: {name}{reason}")
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    sys.exit(1 if counts["failed"] else 0)


if __name__ == "__main__":
    main()
