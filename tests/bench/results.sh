#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Measures what docs/results.md and the tables of docs/ claim: runs each command, one after the other, and writes what it
# prints into FOLDER/NAME.txt. Takes hours on all of them; the machine should do nothing else.
#   tests/bench/results.sh BUILD FOLDER [NAME...]     NAME: some of them only
#   FILMS=FOLDER tests/bench/results.sh ...           also real_films, with the films that truth.py has made
# tracking, films and real_films also update their tables and pictures in docs/.
set -eu
cd "$(dirname "$0")/../.."
usage='usage: tests/bench/results.sh BUILD FOLDER [NAME...]'
build=$(realpath "${1:?$usage}")
mkdir -p "${2:?$usage}"
folder=$(realpath "$2")
shift 2

benchmark() { meson test -C "$build" --benchmark --verbose "$1"; }
program() { # TARGET COMMAND...
    meson compile -C "$build" "$1" && shift && "$@"
}
run() { # NAME
    case $1 in
    tracking) tests/bench/tracking.sh "$build" --sizes 640x360,1280x720,1920x1080,3840x2160 ;;
    real_films) tests/bench/real_films.sh "$build" "$FILMS" ;;
    films) tests/bench/pathologies.sh "$build" ;;
    tension_hard) program bench_tension_hard "$build/tests/bench/bench_tension_hard" ;;
    calibration) program bench_calibration "$build/tests/bench/bench_calibration" 6 ;;
    workspace) program workspace_map meson devenv -C "$build" apps/workspace_map --table ;;
    hazards) meson test -C "$build" --suite hazards --verbose ;;
    paper) mkdir -p "$folder/paper" && program paper_figures "$build/apps/paper_figures" "$folder/paper" ;;
    *) benchmark "$1" ;;
    esac
}

[ $# -gt 0 ] || set -- analysis tracking films ${FILMS:+real_films} skew loop link cost record smoothness filter \
    tension tension_hard pose workspace calibration safety hazards touch touch_strings touch_loop paper
failed=
for name in "$@"; do
    echo "$name -> $folder/$name.txt"
    run "$name" >"$folder/$name.txt" 2>&1 || failed="$failed $name"
    # That is no error for Meson.
    ! grep -q '^No suitable tests' "$folder/$name.txt" || failed="$failed $name"
done
[ -z "$failed" ] || { echo "results.sh: failed, see their files:$failed" >&2; exit 1; }
