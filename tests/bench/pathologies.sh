#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Prints the table of films with unusual frames: pathologies.sh BUILD [CLIP...]. pathologies.py describes what is
# measured; without a CLIP nothing has to be downloaded. Needs ffmpeg.
set -eu
cd "$(dirname "$0")/../.."
build=${1:?usage: tests/bench/pathologies.sh BUILD [CLIP...]}
meson compile -C "$build" plugin/gstspidar
exec python3 tests/bench/pathologies.py "$@"
