#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# check_play_script.sh SOURCE: examples/play.sh builds everything that it and the next step of docs/start.md use: the
# plugins, the guardian, without which no real board is opened, spidar-feel, and the program of the debug window.
# Nothing but apt gets root's rights: a user's sudo may ask for a password, and under sudo the script goes on as the
# user who called it. The script runs in a copy of the tree in which ninja, sudo, apt and the player only note what they
# are asked for.
set -euo pipefail
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{bin,build/examples/play,examples,tests}
cp "$1/examples/play.sh" "$tree/examples/"
cp "$1/tests/install.sh" "$tree/tests/"
echo "build plugin/spidar-window: with its libraries" >"$tree/build/build.ninja"
touch "$tree/asked"
chmod -R a+rwX "$tree"
note='#!/bin/bash\nprintf "%%s\\n" "$(id -u) ${0##*/} $*" >>'"$tree"'/asked\n'
for program in bin/{ninja,sudo,apt-get,dpkg-query} build/examples/play/play; do
    # shellcheck disable=SC2059  # the format is ours
    printf "$note" >"$tree/$program"
    chmod a+rx "$tree/$program"
done
echo 'echo no work to do' >>"$tree/bin/ninja"

fail() {
    echo "play.sh $1, but asked for: $(<"$tree/asked")"
    exit 1
}

arguments=(--ball)
# run [NAME=VALUE...]: the script with these arguments, by root if the test has its rights.
run() {
    : >"$tree/asked"
    env -u DISPLAY -u WAYLAND_DISPLAY -u SUDO_USER PATH="$tree/bin:$PATH" "$@" \
        "$tree/examples/play.sh" "${arguments[@]}" >/dev/null
}

run_as_user() {
    if ((EUID == 0)); then
        run setpriv --reuid 65534 --regid 65534 --clear-groups env
    else
        run
    fi
}

: >"$tree/tests/debian-packages.txt" # none is missing
run
for target in plugin/libgstspidar{,feel}.so plugin/spidar-{feel,window} spidar/spidar-guardian examples/play/play; do
    grep -qw -- "$target" "$tree/asked" || fail "does not build $target"
done

echo "a-package build a reason" >"$tree/tests/debian-packages.txt"
run_as_user
grep -q ' sudo -v$' "$tree/asked" || fail "does not let sudo ask for a password"
grep -q ' sudo env .*apt-get .*install .*a-package$' "$tree/asked" || fail "does not install by sudo"
grep -q ' play ' "$tree/asked" || fail "does not play"
if ((EUID == 0)); then
    run SUDO_USER=somebody SUDO_UID=12345
    grep -q '^0 apt-get .*install .*a-package$' "$tree/asked" || fail "does not install under sudo"
    grep -q "^0 sudo -u somebody .*$tree/examples/play.sh --ball\$" "$tree/asked" || fail "does not go on as the caller"
    ! grep -qE '^0 (ninja|play) ' "$tree/asked" || fail "builds or plays as root under sudo"
fi

# Options that say how the clip is played are not taken for a film, and nothing is fetched for a typo.
: >"$tree/tests/debian-packages.txt"
mkdir -p "$tree/cache/gst-spidar"
touch "$tree/cache/gst-spidar/balle-jbart.mp4"
# plays EXPECTED ARGUMENT...: what the player is asked for.
plays() {
    arguments=("${@:2}")
    run XDG_CACHE_HOME="$tree/cache"
    grep -qx -- "[0-9]* play $1" "$tree/asked" || fail "${*:2} does not play $1"
}
clip=$tree/cache/gst-spidar/balle-jbart.mp4
plays "--headless $clip" --headless
plays "--seconds 5 $clip" --seconds 5
plays "--seconds=5 $clip" --seconds=5
plays "--seconds 5 --ball" --seconds 5 --ball
plays "--ball --seconds 5 --output there" --ball --seconds 5 --output there
plays "--seconds 5 film.mp4" film.mp4 --seconds 5
plays "--bal" --bal
