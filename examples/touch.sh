#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Simulates a hand that strokes across a picture, as with touch=luma, and ends with some numbers and
# a picture of relief, path and force. First installs missing packages (Debian) and builds.
#   examples/touch.sh IMAGE
#   examples/touch.sh IMAGE --output FOLDER
#   examples/touch.sh DEPTH --depth           # an image of depth: bright is near, black is unknown
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. "$top/tests/install.sh"

install_packages build play
continue_as_caller "$top/examples/touch.sh" "$@"
if [[ ! -f $top/build/build.ninja ]]; then
    meson setup "$top/build" "$top" >/dev/null
fi
if [[ $(ninja -C "$top/build" -n examples/touch/touch) != *"no work to do"* ]]; then
    echo "building; the first time, this takes some minutes"
    ninja -C "$top/build" examples/touch/touch >/dev/null
fi
exec "$top/build/examples/touch/touch" "$@"
