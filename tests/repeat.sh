#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Runs the tests N times on a busy machine: beside them, as many processes compute as there are processors, or twice as
# many. Prints each failure once, with how often it came; the exit status is 1 if there was any.
#   tests/repeat.sh [--twice] N [SUITE...]    by default, all suites that run every day, without `long`
# The build is build/, which is made first if it is not there. What a test printed is in build/meson-logs/repeat-N.txt.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

busy=$(nproc)
if [[ ${1-} == --twice ]]; then
    busy=$((2 * busy))
    shift
fi
if [[ ! ${1-} =~ ^[1-9][0-9]*$ ]]; then
    echo "error: usage: tests/repeat.sh [--twice] N [SUITE...]" >&2
    exit 2
fi
rounds=$1
shift
suites=(--no-suite long)
(($# == 0)) || suites=()
for suite in "$@"; do suites+=(--suite "$suite"); done

[[ -f build/build.ninja ]] || meson setup build -Dunity=on
ninja -C build

# They also end when this script is killed.
for ((n = 0; n < busy; ++n)); do
    while kill -0 $$ 2>/dev/null; do :; done &
done
failures=$(mktemp)
# shellcheck disable=SC2046  # one word for each process
trap 'kill $(jobs -p); rm -f "$failures"' EXIT

for ((round = 1; round <= rounds; ++round)); do
    rm -f build/*.xml "build/meson-logs/repeat-$round".*
    # A timeout is for what hangs: ten times that of the test. As many tests at once as in run.sh.
    meson test -C build --no-rebuild -t 10 --num-processes "$((2 * $(nproc)))" --quiet --logbase "repeat-$round" \
        "${suites[@]}" || true
    printf '== round %d of %d: ' "$round" "$rounds"
    python3 tests/summary.py --failures --log "repeat-$round" build | tee -a "$failures" | wc -l
done
awk -F '\t' -v rounds="$rounds" '!count[$1]++ { why[$1] = $2 }
    END { for (name in count) printf "%d of %d: %s: %s\n", count[name], rounds, name, why[name] }' "$failures" | sort -rn
[[ ! -s $failures ]]
