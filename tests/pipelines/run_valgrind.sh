#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# run_valgrind.sh PROGRAM SUPPRESSIONS: fails on an access that is invalid, a value that was never
# set, and memory that is definitely lost. Skipped (77) where there is no Valgrind.
if ! command -v valgrind >/dev/null; then
    echo "skipped: no valgrind; apt-get install valgrind"
    exit 77
fi
# First without: GStreamer reads every plugin there is for its registry, and not again.
"$1" || exit
export G_SLICE=always-malloc
exec valgrind --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite \
    --show-leak-kinds=definite --num-callers=40 --suppressions="$2" "$1"
