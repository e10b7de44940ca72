#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# run_valgrind.sh PROGRAM SUPPRESSIONS: fails on invalid accesses, uninitialised values and definite
# leaks. Skipped (77) without Valgrind.
if ! command -v valgrind >/dev/null; then
    echo "skipped: no valgrind; apt-get install valgrind"
    exit 77
fi
# First a run without Valgrind, in which GStreamer scans all plugins for its registry.
"$1" || exit
export G_SLICE=always-malloc
exec valgrind --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite \
    --show-leak-kinds=definite --num-callers=40 --suppressions="$2" "$1"
