#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# The tables and the picture of real films in docs/tracking.md: real_films.sh BUILD FOLDER. What
# FOLDER holds is said in real_films.py. No film is part of this repository.
#
# The table of methods and the picture need the packages libavformat-dev (if it is installed after
# `meson setup`: `meson configure --clearcache BUILD`), ffmpeg and gnuplot; without them it ends with a
# message after the others.
set -eu
cd "$(dirname "$0")/../.."
build=${1:?usage: tests/bench/real_films.sh BUILD FOLDER}
folder=${2:?usage: tests/bench/real_films.sh BUILD FOLDER}
meson compile -C "$build"
python3 tests/bench/real_films.py "$build" "$folder" "$build/real_films.csv"
[ ! -s "$build/real_films.csv" ] ||
    gnuplot -e "csv='$build/real_films.csv'; picture='docs/figures/real_films.png'" tests/bench/real_films.gp
