#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Runs the tests with newer releases than this machine's, on Debian, as root, without asking. The
# last line is `N passed, N failed, N skipped`; the exit status is 0 when nothing failed.
#   tests/runtimes.sh debian-13       builds and tests everything with the packages of Debian 13
#   tests/runtimes.sh debian-13-players  runs the suite `players` with the players of Debian 13
#   tests/runtimes.sh gstreamer-1.28  tests what is built in build/ with GStreamer 1.28 and GLib, those
#                                     of Debian 14: element, pipelines, examples
# Each keeps a small Debian of its own, of 2 GB and 1 GB, in ${XDG_CACHE_HOME:-~/.cache}/gst-spidar/ for
# later runs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh
# shellcheck source-path=SCRIPTDIR source=../tests/debian_folder.sh
. tests/debian_folder.sh

runtime=${1-}
case $runtime in
debian-13 | debian-13-players) suite=trixie ;;
gstreamer-1.28) suite=forky ;;
*)
    echo "error: unknown runtime '$runtime'; usage: tests/runtimes.sh debian-13|debian-13-players|gstreamer-1.28" >&2
    exit 2
    ;;
esac
need_own_mounts tests/runtimes.sh "$runtime"
root=$debian_cache/${runtime%-players}

# mount_in_root OPTION: also this folder, at the same place; OPTION is ro or rw.
mount_in_root() {
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mkdir -p "$root$PWD"
    mount --bind "$PWD" "$root$PWD"
    mount -o "remount,bind,$1" "$root$PWD"
}

# in_root COMMAND...: there, in this folder.
in_root() { chroot "$root" env -C "$PWD" "$@"; }

# test_with_other_packages [SUITE]: everything that is tested every day, or this suite.
test_with_other_packages() {
    local build=/build only=() groups=(build newer-build test play)
    if (($#)); then
        only=(--suite "$1")
        groups+=("$1" "newer-$1")
    fi
    in_root bash -euc '. tests/install.sh; install_packages "$@"' - "${groups[@]}"
    say "building in $root$build: $(in_root g++ --version | head -n 1)"
    # What another clone of the project has built refers to its sources.
    grep -qF "\"source\": \"$PWD\"" "$root$build/meson-info/meson-info.json" 2>/dev/null || rm -rf "${root:?}$build"
    [[ -f $root$build/build.ninja ]] || in_root meson setup "$build" -Dunity=on --werror
    # Results of an earlier run would stand for a test program that crashes in this one.
    rm -f "$root$build"/*.xml "$root$build"/meson-logs/testlog*
    in_root ninja -C "$build" -j"$(nproc)"
    say "testing there"
    in_root meson test -C "$build" --print-errorlogs "${only[@]}" || true
    say "summary: $(in_root gst-inspect-1.0 --version | tail -n +2 | head -n 1), Debian $suite"
    in_root python3 tests/summary.py "$build"
}

# Links in $root$1 to those libraries of this machine that what is built needs and that are not there.
link_missing_libraries() {
    local links=$1 name path
    local -A is_there=()
    rm -rf "${root:?}$links"
    mkdir -p "$root$links" "$root/host"
    mount --bind / "$root/host"
    while read -r name _; do is_there[$name]=yes; done < <(in_root ldconfig -p)
    while read -r name path; do
        [[ ${is_there[$name]-} || $path == "$PWD"/* ]] ||
            ln -s "/host$(realpath "$path")" "$root$links/$name"
    done < <(find build -type f -perm -u+x -exec ldd {} + |
        awk '$2 == "=>" { print $1, $3 }' | sort -u)
}

test_with_other_gstreamer() {
    local links=/host-libraries log=testlog-chroot  # meson names it after the wrapper
    in_root bash -euc '. tests/install.sh; install_packages gstreamer'
    say "building in build/"
    install_packages build test
    [[ -f build/build.ninja ]] || meson setup build
    ninja -C build -j"$(nproc)"
    link_missing_libraries "$links"
    rm -f build/*.xml build/meson-logs/"$log"*
    local with=(env -C "$PWD/build" "LD_LIBRARY_PATH=$links" "GST_REGISTRY=$links/registry.bin")
    say "testing with these libraries of Debian $suite, all others of this machine"
    in_root "${with[@]}" ldd plugin/libgstspidar.so | grep -E 'libgst|libg(lib|object)'
    in_root "${with[@]}" gst-inspect-1.0 plugin/libgstspidar.so
    meson test -C build --no-rebuild --print-errorlogs \
        --wrapper "chroot '$root' ${with[*]@Q}" --suite element --suite pipelines --suite examples || true
    say "summary: $(in_root gst-inspect-1.0 --version | tail -n +2 | head -n 1)," \
        "built with $(pkg-config --modversion gstreamer-1.0)"
    python3 tests/summary.py --log "$log" build
}

make_debian "$suite" "$root"
case $runtime in
debian-13)
    mount_in_root ro
    test_with_other_packages
    ;;
debian-13-players)
    mount_in_root ro
    test_with_other_packages players
    ;;
gstreamer-1.28)
    mount_in_root rw
    test_with_other_gstreamer
    ;;
esac
