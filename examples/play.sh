#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Plays a video whose motion becomes force on the device that is plugged in, or a simulated one, and ends with a
# summary and a picture of the force. First installs missing packages (Debian) and builds; in the end, once, it builds
# the other programs.
#   examples/play.sh                             ten seconds of a ball, in slow motion
#   examples/play.sh VIDEO                       a file, or a URI such as https://...
#   examples/play.sh VIDEO -- controller=linear max-force=2    with properties of spidarmotion
#   examples/play.sh --window                    with the debug window
#   examples/play.sh --ball --output FOLDER      without a video; see --help
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source-path=SCRIPTDIR source=../tests/install.sh
. "$top/tests/install.sh"

# Runs a command and shows what it prints only if it fails.
quietly() {
    local log status=0
    log=$(mktemp)
    "$@" >"$log" 2>&1 || status=$?
    ((status == 0)) || cat "$log" >&2
    rm -f "$log"
    return "$status"
}

# make TEXT TARGET...: builds what is missing, after a line with TEXT. On a terminal, a line says how far it is.
make() {
    if [[ $(ninja -C "$top/build" -n "${@:2}") != *"no work to do"* ]]; then
        echo "$1"
        if [[ -t 1 ]]; then
            ninja -C "$top/build" "${@:2}"
        else
            quietly ninja -C "$top/build" "${@:2}"
        fi
    fi
}

# What the film needs. The guardian is needed by real boards.
build() {
    if [[ ! -f $top/build/build.ninja ]]; then
        quietly meson setup "$top/build" "$top" -Dunity=on  # several files compiled as one: faster
    fi
    # The debug window is a program of its own, if there are the libraries for it.
    ! grep -q '^build plugin/spidar-window:' "$top/build/build.ninja" || window=(plugin/spidar-window)
    local targets=(plugin/libgstspidar.so spidar/spidar-guardian examples/play/play)
    [[ " ${options[*]-} ${properties[*]-}" != *" --window"* && "${properties[*]-}" != *debug-window* ]] ||
        targets+=("${window[@]}")
    make "building; the first time, this takes some minutes" "${targets[@]}"
}

# What README.md and docs/start.md go on with.
build_programs() {
    make "building spidar-feel, spidartrack, spidarctl and the debug window for the next steps" \
        plugin/{libgstspidarfeel.so,spidar-feel,spidartrack} spidar/tools/spidarctl "${window[@]}"
}

# A free film of a tennis ball that is dropped, in slow motion; the camera lies on its side.
clip_package=python3-mecavideo
clip_path=./usr/share/pymecavideo/data/video/balle-jbart.mp4
clip=${XDG_CACHE_HOME:-$HOME/.cache}/gst-spidar/${clip_path##*/}

# Downloads the clip's package once, without installing it. Fails when that is not possible.
fetch_clip() {
    local cache=${clip%/*}
    if [[ ! -f $clip ]]; then
        mkdir -p "$cache"
        local work
        work=$(mktemp -d "$cache/download.XXXXXX")
        # This function is called in a subshell: the folder is removed when that exits, also by Ctrl-C.
        # shellcheck disable=SC2064  # expanded now, because the variable is local
        trap "rm -rf '$work'" EXIT
        # The user _apt may not write here; apt would warn about it when run as root.
        if (cd "$work" && apt-get -qq -o APT::Sandbox::User="$(id -un)" download "$clip_package" &&
            dpkg-deb --fsys-tarfile "$clip_package"_*.deb |
            tar -x "$clip_path") >"$work/log" 2>&1; then
            mv "$work/$clip_path" "$clip"
        fi
    fi
    [[ -f $clip ]]
}

arguments=("$@")
window=()  # what is built of it
options=()
video=()
properties=()
needs_clip=yes
while (($#)); do
    case $1 in
    --)
        properties=("$@")
        break
        ;;
    --output | --window-png | --seconds)
        (($# > 1)) || needs_clip=no
        options+=("${@:1:2}")
        shift
        ;;
    --seconds=* | --output=* | --window-png=* | --verbose | --headless | --window) options+=("$1") ;;
    -*) # these need no clip: --ball, --help, and a typo, which the player names
        options+=("$1")
        needs_clip=no
        ;;
    *)
        video+=("$1")
        needs_clip=no
        ;;
    esac
    (($#)) && shift
done

play=$top/build/examples/play/play
# Who asks for help waits for no build, unless there was none.
[[ " ${options[*]-} " != *" --help "* || ! -x $play ]] || exec "$play" --help

install_packages build play
if [[ -n ${DISPLAY-}${WAYLAND_DISPLAY-} ]]; then
    install_packages display || echo "continuing without them; there may be no window"
fi
continue_as_caller "$top/examples/play.sh" "${arguments[@]}"
build

if [[ $needs_clip == yes ]]; then
    [[ -f $clip ]] || echo "fetching a clip, once: ${clip##*/} of Debian's package $clip_package (4 MB)"
    if (fetch_clip); then
        video=("$clip")
    else
        echo "it cannot be had, perhaps for want of a network: playing a ball of videotestsrc"
        options+=(--ball)
    fi
fi

export GST_PLUGIN_PATH=$top/build/plugin${GST_PLUGIN_PATH:+:$GST_PLUGIN_PATH}
export GST_REGISTRY=$top/build/gst-registry.bin
status=0
"$play" "${options[@]}" "${video[@]}" "${properties[@]}" || status=$?
build_programs
exit "$status"
