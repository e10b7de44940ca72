#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# check_play_script.sh SOURCE: examples/play.sh builds everything that it and the next step of docs/start.md use: the
# plugins, the guardian, without which no real board is opened, and spidar-feel. The script runs in a copy of the
# tree in which ninja only notes what it is asked for.
set -euo pipefail
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{bin,build/examples/play,examples,tests}
cp "$1/examples/play.sh" "$tree/examples/"
cp "$1/tests/install.sh" "$tree/tests/"
touch "$tree/tests/debian-packages.txt" "$tree/build/build.ninja"
printf '#!/bin/sh\necho "$@" >>"%s/asked"; echo no work to do\n' "$tree" >"$tree/bin/ninja"
printf '#!/bin/sh\nexit 0\n' >"$tree/build/examples/play/play"
chmod +x "$tree/bin/ninja" "$tree/build/examples/play/play"
env -u DISPLAY -u WAYLAND_DISPLAY PATH="$tree/bin:$PATH" "$tree/examples/play.sh" --ball
for target in plugin/libgstspidar{,feel}.so plugin/spidar-feel spidar/spidar-guardian examples/play/play; do
    grep -qw -- "$target" "$tree/asked" || {
        echo "play.sh does not build $target, but only: $(<"$tree/asked")"
        exit 1
    }
done
