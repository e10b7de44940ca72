#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Makes the pictures of the debug window, without a screen, and the README's: `meson compile -C build screenshots`, or
#   docs/figures/screenshots.sh BUILD
# Writes debug_window.png, window_touch.png and show.gif into its own folder. Needs ffmpeg, xvfb, python3-numpy,
# gstreamer1.0-libav (MJPEG), an H.264 encoder (gstreamer1.0-plugins-bad or -ugly) and fonts-dejavu-core.
set -euo pipefail
build=$(realpath "${1:?usage: docs/figures/screenshots.sh BUILD}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
size=1280x800

work=$(mktemp -d)
server=
trap '[[ -z $server ]] || kill "$server" 2>/dev/null || true; rm -rf "$work"' EXIT

"$here/made_film.py" 6 | ffmpeg -v error -f rawvideo -pix_fmt rgb24 -video_size 848x480 -framerate 30 -i - \
    -c:v mjpeg -q:v 2 -pix_fmt yuvj420p "$work/period.avi"
ffmpeg -v error -stream_loop 5 -i "$work/period.avi" -c copy "$work/meadow.avi"

export GST_PLUGIN_PATH=$build/plugin${GST_PLUGIN_PATH:+:$GST_PLUGIN_PATH}
export GST_REGISTRY=$work/registry.bin
unset WAYLAND_DISPLAY
Xvfb -displayfd 3 -screen 0 ${size}x24 -noreset -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
until [[ -s $work/display ]]; do
    kill -0 "$server" || { echo "Xvfb does not start" >&2; exit 1; }
    sleep 0.1
done
DISPLAY=:$(<"$work/display")
export DISPLAY

"$build/examples/play/play" --headless --output "$work" --seconds 30 --window-png "$work/window.png" \
    "$work/meadow.avi" >"$work/play.log" 2>&1 || { cat "$work/play.log" >&2; exit 1; }
cp "$work/window.png" "$here/debug_window.png"

"$build/examples/play/play" --headless --output "$work" --seconds 9 --window-png "$work/touch.png" \
    "$work/meadow.avi" -- touch=luma touch-relief=20 >"$work/play.log" 2>&1 || { cat "$work/play.log" >&2; exit 1; }
ffmpeg -v error -y -i "$work/touch.png" -filter_complex \
    "split[a][b];[a]palettegen=max_colors=256[p];[b][p]paletteuse=dither=none" "$here/window_touch.png"

# The second period: in the first one, the curve begins. One palette for all frames; what rests costs nothing.
"$build/plugin/spidartrack" show "$work/meadow.avi" "$work/meadow.mp4"
ffmpeg -v error -y -ss 6 -t 6 -i "$work/meadow.mp4" -filter_complex \
    "fps=12,scale=640:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=128:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
    "$here/show.gif"
ls -l "$here/debug_window.png" "$here/show.gif" "$here/window_touch.png"
