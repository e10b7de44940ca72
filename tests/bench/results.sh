#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Measures what the pages of docs/ claim: runs each command, one after the other, and writes the tables that it prints
# into BUILD/results/NAME.txt, which a release attaches. All of them take hours; the machine should do nothing else.
#   tests/bench/results.sh BUILD [NAME...]     NAME: some of them only
#   FILMS=FOLDER tests/bench/results.sh ...    also real_films and constants, with the films that truth.py has made
set -eu
cd "$(dirname "$0")/../.."
build=$(realpath "${1:?usage: tests/bench/results.sh BUILD [NAME...]}")
folder=$build/results
mkdir -p "$folder"
shift

benchmark() { meson test -C "$build" --benchmark --verbose "$1"; }
program() { # TARGET COMMAND...
    meson compile -C "$build" "$1" && shift && "$@"
}
run() { # NAME
    case $1 in
    tracking) program bench_tracking "$build/tests/bench/bench_tracking" --sizes 640x360,1280x720,1920x1080,3840x2160 ;;
    real_films) tests/bench/real_films.sh "$build" "$FILMS" ;;
    constants) tests/bench/constants.py "$FILMS" ;;
    films) tests/bench/pathologies.sh "$build" ;;
    tension_hard) program bench_tension_hard "$build/tests/bench/bench_tension_hard" ;;
    calibration) program bench_calibration "$build/tests/bench/bench_calibration" 6 ;;
    hazards) meson test -C "$build" --suite hazards --verbose ;;
    paper) meson devenv -C "$build" "$PWD/docs/figures/paper_figures.py" "$folder" ;;
    *) benchmark "$1" ;;
    esac
}

[ $# -gt 0 ] || set -- analysis tracking films ${FILMS:+real_films constants} skew loop link cost record smoothness filter \
    tension tension_hard pose calibration safety hazards touch touch_strings touch_loop paper
failed=
for name in "$@"; do
    echo "$name -> $folder/$name.txt"
    run "$name" >"$folder/$name.txt" 2>&1 || failed="$failed $name"
    # That is no error for Meson.
    ! grep -q '^No suitable tests' "$folder/$name.txt" || failed="$failed $name"
done
[ -z "$failed" ] || { echo "results.sh: failed, see their files:$failed" >&2; exit 1; }
