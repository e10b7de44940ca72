#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Runs the two commands of the README in a folder with a Debian 12 that has only the packages of
# every Debian, as root. A package that the tests or examples/play.sh need fails here unless
# tests/debian-packages.txt lists it. Nothing of this machine is visible from there: this source
# tree is copied, and only proc, dev/pts and dev/shm are mounted. Warnings of the compiler are
# errors.
#   tests/bare_debian.sh RESULTS   leaves the tests' results in RESULTS/meson-logs, for summary.py
# The exit status is 0 when the tests have run, whatever their results, and play.sh has succeeded. A
# small Debian, 0.2 GB, and the packages, 0.3 GB, are kept in
# ${XDG_CACHE_HOME:-~/.cache}/gst-spidar/ for later runs; installed packages and builds are not.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh
# shellcheck source-path=SCRIPTDIR source=../tests/debian_folder.sh
. tests/debian_folder.sh

if (($# != 1)); then
    echo "error: usage: tests/bare_debian.sh RESULTS" >&2
    exit 2
fi
results=$1
rm -rf "$results/meson-logs"  # of an earlier run
need_own_mounts tests/bare_debian.sh "$results"

suite=bookworm
base=$debian_cache/debian-12
packages=$debian_cache/debian-12-packages
source=/gst-spidar  # in there
archives=/var/cache/apt/archives

make_debian "$suite" "$base"
root=$(mktemp -d "$debian_cache/debian-12.XXXXXX")
remove_root() {
    umount --lazy "$root"/{proc,dev/pts,dev/shm} 2>/dev/null || true
    rm -rf --one-file-system "$root"
}
trap remove_root EXIT
# Of a folder that mktemp makes only its owner may see the inside: apt's own user needs to.
chmod 755 "$root"
cp -a "$base/." "$root"
cp -L /etc/resolv.conf "$root/etc/"
mkdir -p "$packages" "$root$source"
find "$packages" -name '*.deb' -exec cp -t "$root$archives" {} +
tar -c --exclude=./.git --exclude='./build*' . | tar -x -C "$root$source"
mount -t proc proc "$root/proc"
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts "$root/dev/pts"
ln -sf pts/ptmx "$root/dev/ptmx"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"

# in_root COMMAND...: there, in the copy of this folder, with the environment of a fresh log-in.
in_root() {
    chroot "$root" env -i -C "$source" HOME=/root "PATH=/usr/sbin:/usr/bin:/sbin:/bin" \
        ${http_proxy:+"http_proxy=$http_proxy"} "$@"
}

status=0
say "on a bare Debian 12: tests/run.sh"
in_root CXXFLAGS=-Werror tests/run.sh || true
if [[ -f $root$source/build/meson-logs/testlog.json ]]; then
    mkdir -p "$results"
    cp -r "$root$source/build/meson-logs" "$results"
else
    status=1
fi
say "on a bare Debian 12: examples/play.sh --ball"
in_root examples/play.sh --ball --output /tmp && [[ -s $root/tmp/spidar-play.png ]] || status=1
# Those of this run: what it did not need is out of date.
rm -rf "$packages"
mv "$root$archives" "$packages"
exit "$status"
