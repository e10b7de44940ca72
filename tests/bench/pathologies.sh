#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Prints what becomes of the force when a film is played as players, editors and encoders make it:
#   tests/bench/pathologies.sh                     of films that are made for it, nothing to download
#   tests/bench/pathologies.sh CLIP|FOLDER...      of clips, each one shot of two seconds or more, or all in a folder
# Plays through the spidarmotion of build/ or $BUILD; needs ffmpeg.
set -eu
build=$(realpath "${BUILD:-$(dirname "$0")/../../build}")
meson compile -C "$build" plugin/gstspidar
exec python3 "$(dirname "$0")/pathologies.py" "$build" "$@"
