# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Sourced by tests/runtimes.sh, tests/bare_debian.sh and tests/packages.sh: makes a folder with a
# Debian of another release or with fewer packages. tests/install.sh must have been sourced.
# shellcheck shell=bash

# Where such folders are kept between runs.
debian_cache=${XDG_CACHE_HOME:-$HOME/.cache}/gst-spidar

say() { printf '\n== %s\n' "$*"; }

# need_own_mounts SCRIPT [ARGUMENT...]: starts the script again in a mount namespace of its own, so
# that whatever it mounts is gone when it ends, however it ends. Needs root.
need_own_mounts() {
    if ((EUID != 0)); then
        echo "error: a Debian in a folder needs root. Run: sudo $*" >&2
        exit 1
    fi
    [[ -n ${GST_SPIDAR_OWN_MOUNTS-} ]] ||
        GST_SPIDAR_OWN_MOUNTS=1 exec unshare --mount --propagation private "$@"
}

# choose_debian RELEASE: sets $suite, and $base to the folder where make_debian is to put that Debian.
# shellcheck disable=SC2034  # the callers use base
choose_debian() {
    case $1 in
    debian-12) suite=bookworm base=$debian_cache/debian-12 ;;
    debian-13) suite=trixie base=$debian_cache/bare-debian-13 ;;  # debian-13 is that of tests/runtimes.sh
    *)
        echo "error: unknown release '$1'; it is debian-12 or debian-13" >&2
        exit 2
        ;;
    esac
}

# make_debian SUITE FOLDER: the packages that every Debian has. Does nothing when the folder is there.
make_debian() {
    local suite=$1 folder=$2
    [[ ! -d $folder ]] || return 0
    say "Debian $suite in $folder"
    install_packages runtimes
    rm -rf "$folder.part"
    mkdir -p "$folder.part"
    # A suite that this machine's debootstrap is too old to know is made like unstable.
    local rules=/usr/share/debootstrap/scripts/$suite
    [[ -e $rules ]] || rules=/usr/share/debootstrap/scripts/sid
    if ! debootstrap --variant=minbase "$suite" "$folder.part" "" "$rules" >"$folder.log" 2>&1; then
        cat "$folder.log" >&2
        exit 1
    fi
    # The lists of a suite that is not out yet expire after days; a mirror may be older than that.
    echo 'Acquire::Check-Valid-Until "false";' >"$folder.part/etc/apt/apt.conf.d/gst-spidar"
    mv "$folder.part" "$folder"
}
