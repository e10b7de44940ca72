#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Prints five tables of what is felt in real films:
#   tests/bench/real_films.sh BUILD FOLDER [OLDER_BUILD]
# real_films.py describes the contents of FOLDER; no film is part of this repository. OLDER_BUILD is
# the build folder of another version, for a row of the first table; without it that row is missing.
# Needs ffmpeg and libavformat-dev (if it is installed after `meson setup`: `meson
# configure --clearcache BUILD` and `meson setup --reconfigure BUILD`).
set -eu
cd "$(dirname "$0")/../.."
usage='usage: tests/bench/real_films.sh BUILD FOLDER [OLDER_BUILD]'
build=${1:?$usage}
folder=${2:?$usage}
shift 2
ninja -C "$build" -t targets all | grep -q '^tests/bench/bench_real_film:' ||
    { echo "real_films.sh: no bench_real_film in $build: it needs libavformat-dev" >&2; exit 1; }
meson compile -C "$build" plugin/gstspidar bench_real_film
exec python3 tests/bench/real_films.py "$build" "$folder" "$@"
