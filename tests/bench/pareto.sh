#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Draws speed against error on real films: tests/bench/pareto.sh FOLDER... [option...]; pareto.py says what it needs and
# writes. The build folder, build/ or $BUILD, needs -Dbenchmarks=enabled, libavformat-dev, ffmpeg and gnuplot.
set -eu
[ $# -gt 0 ] || { echo "usage: tests/bench/pareto.sh FOLDER... [--lines N...] [--method NAME...] [--output FOLDER]" >&2; exit 1; }
cd "$(dirname "$0")/../.."
meson compile -C "${BUILD:-build}" spidar-bench
exec python3 tests/bench/pareto.py "$@"
