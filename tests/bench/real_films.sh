#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Prints what is felt in real films, and what that costs: tests/bench/real_films.sh FOLDER...
# real_films.py says what a FOLDER contains; no film is part of this repository. The build folder, build/ or $BUILD, needs
# -Dbenchmarks=enabled, libavformat-dev and ffmpeg.
set -eu
[ $# -gt 0 ] || { echo "usage: tests/bench/real_films.sh FOLDER..." >&2; exit 1; }
cd "$(dirname "$0")/../.."
meson compile -C "${BUILD:-build}" plugin/gstspidar spidar-bench
exec python3 tests/bench/real_films.py "$@"
