#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Updates the tables and the picture of docs/tables-tracking.md. Takes about ten minutes.
#   tests/bench/tracking.sh BUILD [option of bench_tracking...]
# for example  tests/bench/tracking.sh build --full --middlebury FOLDER
set -eu
cd "$(dirname "$0")/../.."
build=${1:?usage: tests/bench/tracking.sh BUILD [option of bench_tracking...]}
shift
page=docs/tables-tracking.md
meson compile -C "$build" bench_tracking
"$build/tests/bench/bench_tracking" "$@" >"$build/tracking.txt"
awk -v tables="$build/tracking.txt" '
    /^<!-- end of the tables -->/ { inside = 0 }
    !inside
    /^<!-- tables/ { inside = 1; while ((getline line < tables) > 0) print line; print "" }
' "$page" >"$build/tracking.md"
cp "$build/tracking.md" "$page"
gnuplot -e "page='$page'; picture='docs/figures/tracking.png'" tests/bench/tracking.gp
