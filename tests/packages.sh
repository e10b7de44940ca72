#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Builds the Debian packages in a Debian that has only the packages named by debian/control, checks
# them with lintian, installs the six into a minimal Debian, plays a clip there with the simulated
# device, and builds and runs an example. Needs root; nothing of this machine is visible from there.
#   tests/packages.sh debian-12|debian-13 [FOLDER]   leaves the packages in FOLDER
# The last line is the result. A small Debian, the compiler cache (ccache) and the downloaded
# packages are kept in ${XDG_CACHE_HOME:-~/.cache}/gst-spidar/ for later runs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. tests/install.sh
# shellcheck source-path=SCRIPTDIR source=../tests/debian_folder.sh
. tests/debian_folder.sh

release=${1-}
choose_debian "$release"
folder=$(realpath -m "${2:-packages-$release}")
need_own_mounts tests/packages.sh "$@"

cache=$debian_cache/ccache-$release
downloaded=$debian_cache/downloaded-$release
roots=()
remove_roots() {
    local root
    for root in "${roots[@]}"; do
        umount --lazy "$root"/{proc,dev/pts,dev/shm,ccache,var/cache/apt/archives} 2>/dev/null || true
        rm -rf --one-file-system "$root"
    done
}
trap remove_roots EXIT

# new_root: sets $root to a fresh Debian. It has proc, the devices that every program expects, and the
# packages that were downloaded before.
new_root() {
    root=$(mktemp -d "$debian_cache/packages.XXXXXX")
    roots+=("$root")
    chmod 755 "$root" # apt's own user looks inside
    cp -a "$base/." "$root"
    cp -L /etc/resolv.conf "$root/etc/"
    mkdir -p "$downloaded/partial" "$cache" "$root/ccache"
    mount --bind "$downloaded" "$root/var/cache/apt/archives"
    mount --bind "$cache" "$root/ccache"
    mount -t proc proc "$root/proc"
    mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts "$root/dev/pts"
    ln -sf pts/ptmx "$root/dev/ptmx"
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
}

# in_root COMMAND...: in $root, with the environment of a fresh log-in.
in_root() {
    chroot "$root" env -i -C / HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        "PATH=/usr/sbin:/usr/bin:/sbin:/bin" ${http_proxy:+"http_proxy=$http_proxy"} "$@"
}

apt() {
    in_root apt-get -qq -o Dpkg::Use-Pty=0 -o APT::Keep-Downloaded-Packages=true "$@" >"$root/apt.log" 2>&1 || {
        cat "$root/apt.log" >&2
        echo "error: apt-get $* (see above)" >&2
        exit 1
    }
}

# What is committed, or, in an export without git, all that is not built.
export_sources() {
    if git rev-parse --git-dir >/dev/null 2>&1; then
        git archive HEAD
    else
        tar -c --exclude='./build*' --exclude='./packages-*' .
    fi | tar -x -C "$1"
}

build_packages() {
    new_root
    mkdir -p "$root/build/gst-spidar"
    export_sources "$root/build/gst-spidar"
    say "what debian/control names, and the tools that build and judge packages"
    apt update
    apt install -y --no-install-recommends build-essential fakeroot lintian ccache
    apt build-dep -y --no-install-recommends /build/gst-spidar
    say "dpkg-buildpackage"
    # Nobody but root is in there, who may do more than a builder does; and only the builder may enter the folder.
    in_root useradd --create-home builder
    chmod 700 "$root/build"
    chown -R --reference="$root/home/builder" "$root/build" "$cache"
    in_root su builder -c "cd /build/gst-spidar && env PATH=/usr/lib/ccache:\$PATH CCACHE_DIR=/ccache \
        DEB_BUILD_OPTIONS=parallel=$(nproc) dpkg-buildpackage -us -uc -b"
    say "lintian"
    in_root su builder -c "cd /build && lintian --fail-on warning --info *.changes"
    rm -rf "$folder"
    mkdir -p "$folder"
    find "$root/build" -maxdepth 1 -type f -exec cp -t "$folder" {} +
}

# own_test NAME: one of debian/tests, as autopkgtest runs them.
own_test() {
    cp "debian/tests/$1" "$root/"
    in_root "/$1"
}

try_packages() {
    new_root
    local name names=(gstreamer1.0-spidar libgst-spidar0 libgst-spidar-dev spidar-tools spidar-window python3-gst-spidar) packages=()
    for name in "${names[@]}"; do packages+=("/$name.deb") && cp "$folder/${name}"_*.deb "$root/$name.deb"; done
    say "the six packages in a fresh $release"
    apt update
    apt install -y --no-install-recommends "${packages[@]}"
    in_root test -f /usr/lib/udev/rules.d/70-spidar.rules -a -x /usr/libexec/gst-spidar/spidar-guardian
    say "a clip, with a player"
    apt install -y --no-install-recommends gstreamer1.0-tools gstreamer1.0-plugins-base
    in_root gst-inspect-1.0 spidarmotion | sed -n 1,12p
    own_test clip
    say "tools"
    in_root spidarctl list | sed -n 1,8p
    in_root spidar-feel max-force=2 -- gst-inspect-1.0 spidarmotion >/dev/null
    in_root spidartrack --version
    say "examples of libgst-spidar-dev"
    apt install -y --no-install-recommends g++ pkg-config
    own_test library
    say "and away with them"
    apt purge -y "${names[@]}"
}

make_debian "$suite" "$base"
build_packages
try_packages
echo "$release: six packages built and installed, lintian reports nothing, and a clip was felt"
