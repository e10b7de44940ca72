#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Runs the two commands of the README in a folder with a Debian that has only the packages of
# every Debian, as root. A package that the tests or examples/play.sh need fails here unless
# tests/debian-packages.txt lists it. Nothing of this machine is visible from there: this source
# tree is copied, and only proc, dev/pts and dev/shm are mounted. Warnings of the compiler of
# Debian 12 are errors.
#   tests/bare_debian.sh debian-12|debian-13 RESULTS
# The tests' results are then in RESULTS/meson-logs, for summary.py.
# The exit status is 0 when the tests have run, whatever their results, play.sh has succeeded, and the
# figures of tests/bench/regression.json are as they were. A
# small Debian, 0.2 GB, the packages, 0.3 GB, and what ccache knows, up to 3 GB, are kept in
# ${XDG_CACHE_HOME:-~/.cache}/gst-spidar/ for later runs; installed packages and builds are not.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh
# shellcheck source-path=SCRIPTDIR source=../tests/debian_folder.sh
. tests/debian_folder.sh

if (($# != 2)); then
    echo "error: usage: tests/bare_debian.sh debian-12|debian-13 RESULTS" >&2
    exit 2
fi
release=$1
results=$2
choose_debian "$release"
rm -rf "$results/meson-logs" "$results/first"  # of an earlier run
need_own_mounts tests/bare_debian.sh "$@"

packages=$debian_cache/$release-packages
cache=$debian_cache/$release-ccache
source=/root/gst-spidar  # in there: root's home, which only root may enter, as homes of users are
archives=/var/cache/apt/archives

make_debian "$suite" "$base"
root=$(mktemp -d "$debian_cache/$release.XXXXXX")
remove_root() {
    umount --lazy "$root"/{proc,dev/pts,dev/shm,ccache} 2>/dev/null || true
    ! mountpoint -q "$root/ccache" || return 0
    rm -rf --one-file-system "$root"
}
trap remove_root EXIT
# Of a folder that mktemp makes only its owner may see the inside: apt's own user needs to.
chmod 755 "$root"
cp -a "$base/." "$root"
cp -L /etc/resolv.conf "$root/etc/"
mkdir -p "$packages" "$root$source"
chmod 700 "$(dirname "$root$source")"
find "$packages" -name '*.deb' -exec cp -t "$root$archives" {} +
tar -c --exclude=./.git --exclude='./build*' . | tar -x -C "$root$source"
mount -t proc proc "$root/proc"
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts "$root/dev/pts"
ln -sf pts/ptmx "$root/dev/ptmx"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
mkdir -p "$cache" "$root/ccache"
mount --bind "$cache" "$root/ccache"
# What is unpacked need not survive a power cut.
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/gst-spidar"

# in_root COMMAND...: there, in the copy of this folder, with the environment of a fresh log-in.
in_root() {
    chroot "$root" env -i -C "$source" HOME=/root "PATH=/usr/sbin:/usr/bin:/sbin:/bin" \
        ${http_proxy:+"http_proxy=$http_proxy"} CCACHE_DIR=/ccache CCACHE_MAXSIZE=3G CCACHE_NOHASHDIR=1 \
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "$@"
}

status=0
say "on a bare $release: tests/run.sh --all, which begins with tests/run.sh"
in_root bash -c '. tests/install.sh && install_packages cache' || true
# With this, ccache understands GCC's precompiled headers.
flags=-fpch-preprocess
[[ $release != debian-12 ]] || flags+=" -Werror"
in_root CXXFLAGS="$flags" tests/run.sh --all || true
for folder in first .; do
    if [[ -f $root$source/build/$folder/meson-logs/testlog.json ]]; then
        mkdir -p "$results/$folder"
        cp -r "$root$source/build/$folder/meson-logs" "$results/$folder"
    else
        status=1
    fi
done
say "on a bare $release: examples/play.sh --ball"
in_root examples/play.sh --ball --output /tmp && [[ -s $root/tmp/spidar-play.png ]] || status=1
say "on a bare $release: figures beside those of tests/bench/regression.json"
in_root sh -c 'meson configure build -Dbenchmarks=enabled && ninja -C build tests/bench/spidar-bench plugin/libgstspidar.so &&
    meson test -C build --no-rebuild --benchmark --verbose regression' || status=1
# Those of this run: what it did not need is out of date.
rm -rf "$packages"
mv "$root$archives" "$packages"
exit "$status"
