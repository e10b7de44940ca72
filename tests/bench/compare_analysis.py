#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares the speed of the analysis with that of another version: compare_analysis.py BUILD OLDER_BUILD
[ROUNDS] runs bench_analysis of two meson build folders alternately, ROUNDS times each (default 7), and
prints a table with the median of the median times and the ratio of each pair of runs. A busy machine
affects the ratios less than the times."""

import json
import statistics
import subprocess
import sys
from pathlib import Path

FILTER = "^analyze/"


def medians_ms(build):
    """Median time of a frame by size of the picture."""
    lines = subprocess.run(
        [build / "tests" / "bench" / "bench_analysis", f"--benchmark_filter={FILTER}", "--benchmark_format=json"],
        check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    runs = json.loads(lines)["benchmarks"]
    return {int(run["name"].split("/")[1]): run["median_ms"] for run in runs}


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit("usage: compare_analysis.py BUILD OLDER_BUILD [ROUNDS]")
    rounds = sys.argv[3] if len(sys.argv) > 3 else "7"
    if not rounds.isdigit() or int(rounds) < 1:
        sys.exit(f"compare_analysis.py: ROUNDS is a number from 1 on, not '{rounds}'")
    builds = [Path(folder) for folder in sys.argv[1:3]]
    for build in builds:
        if not (build / "tests" / "bench" / "bench_analysis").exists():
            sys.exit(f"compare_analysis.py: no bench_analysis in {build}: meson compile -C {build} bench_analysis")
    found = [[medians_ms(build) for build in builds] for _ in range(int(rounds))]
    print("| frame | ms | older version | ratio |")
    print("|---|---|---|---|")
    for width in sorted(found[0][0]):
        ours, older = ([pair[k][width] for pair in found] for k in (0, 1))
        ratio = statistics.median(a / b for a, b in zip(ours, older))
        print(f"| {width}x{width * 9 // 16} | {statistics.median(ours):.2f} | {statistics.median(older):.2f} "
              f"| {ratio:.2f} |")


main()
