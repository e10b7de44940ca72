# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Sourced by the scripts in tests/ and examples/: installs Debian packages. apt alone gets root's rights.
# shellcheck shell=bash

# install_packages GROUP...: installs the missing packages of these groups in debian-packages.txt.
# Prints nothing when none is missing. On other systems than Debian it does nothing: the build then
# reports what is missing.
install_packages() {
    local list package groups group choice names=() wanted=() missing=() as_root=()
    list=$(dirname "${BASH_SOURCE[0]}")/debian-packages.txt
    while read -r package groups _; do
        [[ $package != \#* ]] || continue
        for group in ${groups//,/ }; do
            [[ " $* " != *" $group "* ]] || wanted+=("$package")
        done
    done <"$list"

    command -v dpkg-query >/dev/null || return 0
    local -A is_installed=()
    local state
    IFS='|' read -ra names <<<"$(IFS='|' && echo "${wanted[*]}")"
    # dpkg-query fails when it does not know one of the packages; those it knows are printed.
    while read -r package state; do
        [[ $state != installed ]] || is_installed[$package]=yes
    done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${names[@]}" 2>/dev/null)
    for package in "${wanted[@]}"; do
        IFS='|' read -ra names <<<"$package"
        for choice in "${names[@]}"; do
            [[ -z ${is_installed[$choice]-} ]] || continue 2
        done
        missing+=("${names[0]}")
    done
    ((${#missing[@]})) || return 0

    echo "installing ${#missing[@]} Debian packages: ${missing[*]}"
    if ((EUID != 0)); then
        # Asks for the password, if it needs one, on the terminal.
        if ! sudo -v; then
            echo "error: that needs root. Run this, then start again:" >&2
            echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" update && "${as_root[@]}" install -y --no-install-recommends \
        "${missing[@]}"; } >"$log" 2>&1; then
        cat "$log" >&2
        rm -f "$log"
        echo "error: could not install ${missing[*]} (see above)" >&2
        return 1
    fi
    rm -f "$log"
}

# continue_as_caller SCRIPT [argument...]: under sudo, goes on as the user who called it, with the screen and sound of
# that user; what is built and written is then that user's. Else it does nothing.
continue_as_caller() {
    [[ $EUID == 0 && -n ${SUDO_USER-} && $SUDO_USER != root ]] || return 0
    local runtime=/run/user/${SUDO_UID-}
    [[ ! -d $runtime ]] || export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR-$runtime}
    exec sudo -u "$SUDO_USER" --set-home --preserve-env=DISPLAY,WAYLAND_DISPLAY,XAUTHORITY,XDG_RUNTIME_DIR "$@"
}
