#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Checks with clang-tidy (.clang-tidy) the source files that have changed since COMMIT, and those that Git does not know
# yet; by default, since this branch has left origin/main, or since the commit before when it has not. --all checks every
# file, in half an hour. --quick looks at names and braces alone, in a third of the time.
#   tests/check_tidy.sh [--quick] [COMMIT | --all]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

checks=()
if [[ ${1-} == --quick ]]; then
    checks=("--checks=-*,readability-braces-around-statements,readability-identifier-naming")
    shift
fi
sources=('core/*.cpp' 'plugin/*.cpp' 'spidar/*.cpp')
since=${1-}
if [[ -z $since ]]; then
    since=$(git merge-base HEAD origin/main 2>/dev/null || true)
    [[ -n $since && $since != "$(git rev-parse HEAD)" ]] || since=HEAD~1
fi
if [[ $since == --all ]]; then
    mapfile -t files < <(git ls-files "${sources[@]}")
elif git rev-parse -q --verify "$since^{commit}" >/dev/null; then
    mapfile -t files < <(git diff --name-only --diff-filter=d "$since" -- "${sources[@]}" &&
        git ls-files --others --exclude-standard -- "${sources[@]}")
else
    echo "left out: there is no commit $since here to compare with, as in a clone of one commit"
    exit 0
fi
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
# One command for each file, and no precompiled headers: clang does not read those of GCC.
meson setup "$build" -Db_pch=false -Dunity=off -Dtests=false -Dexamples=false >/dev/null
# Not every build has each file.
mapfile -t files < <(python3 - "$build" "${files[@]}" <<'END'
import json, os, sys
commands = json.load(open(os.path.join(sys.argv[1], "compile_commands.json"), encoding="utf-8"))
built = {os.path.relpath(os.path.join(command["directory"], command["file"])) for command in commands}
print(*[file for file in sys.argv[2:] if file in built], sep="\n", end="")
END
)
echo "${#files[@]} files since $since"
((${#files[@]} == 0)) || printf '%s\0' "${files[@]}" |
    xargs -0 -n 8 -P "$(nproc)" clang-tidy --quiet "${checks[@]}" -p "$build" \
    2> >(grep -v 'warnings\? generated' >&2)
