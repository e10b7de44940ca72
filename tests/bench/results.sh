#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Measures what the pages of docs/ claim: runs each command, one after the other, and writes the tables that it prints
# into BUILD/results/NAME.txt, which a release attaches. BUILD has -Dbenchmarks=enabled. All of them take hours; the
# machine should do nothing else.
#   tests/bench/results.sh BUILD [NAME...]     NAME: some of them only
#   FILMS=FOLDER tests/bench/results.sh ...    also real_films, changed_films, same_films and pareto, with films made by
#                                              truth.py
#   GYROSCOPE=FOLDER                           also gyroscope; its script says what is in this folder
set -eu
cd "$(dirname "$0")/../.."
build=$(realpath "${1:?usage: tests/bench/results.sh BUILD [NAME...]}")
folder=$build/results
mkdir -p "$folder"
shift

run() { # NAME
    case $1 in
    real_films) BUILD=$build tests/bench/real_films.sh "$FILMS" ;;
    changed_films) BUILD=$build tests/bench/changed_films.py "$FILMS" ;;
    same_films) BUILD=$build tests/bench/same_films.py "$FILMS" ;;
    pareto) BUILD=$build tests/bench/pareto.sh "$FILMS" --output "$folder" ;;
    gyroscope) BUILD=$build tests/bench/gyroscope.py ${GYROSCOPE:+"$GYROSCOPE"} ;;
    error_bound) SPIDAR_SWEEP=1 "$build/tests/core/test_core" test_error_bound.cpp ;;
    hazards) meson test -C "$build" --suite hazards --verbose ;;
    paper) meson devenv -C "$build" "$PWD/docs/figures/paper_figures.py" "$folder" ;;
    *) bench "$1" ;;
    esac
}
bench() { meson devenv -C "$build" tests/bench/spidar-bench "$@"; }

meson compile -C "$build" spidar-bench plugin/gstspidar tests/core/test_core
[ $# -gt 0 ] || set -- ladder stability camera ${FILMS:+real_films changed_films same_films pareto} gyroscope skew lag loop cost tension pose safety hazards touch_strings turns workspace error_bound paper
failed=
for name in "$@"; do
    echo "$name -> $folder/$name.txt"
    run "$name" >"$folder/$name.txt" 2>&1 || failed="$failed $name"
done
[ -z "$failed" ] || { echo "results.sh: failed, see their files:$failed" >&2; exit 1; }
