#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Makes the pictures of the debug window, without a screen: `meson compile -C build screenshots`, or
#   docs/figures/screenshots.sh BUILD
# Writes debug_window.png, debug_window.gif and window_touch.png into its own folder. On a busy machine
# fewer different frames are drawn. Needs ffmpeg, xvfb, python3-numpy, gstreamer1.0-libav or -good (MJPEG)
# and fonts-dejavu-core.
set -euo pipefail
build=$(realpath "${1:?usage: docs/figures/screenshots.sh BUILD}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
size=1280x800
warm_up=14  # seconds: the window opens, and the plots fill
shown=6     # seconds: a period of the film
rate=12     # frames/s of the animation

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
    "$work/meadow.avi" >"$work/play.log" 2>&1 &
player=$!
sleep "$warm_up"
ffmpeg -v error -f x11grab -draw_mouse 0 -framerate "$rate" -video_size "$size" -t "$shown" -i "$DISPLAY" \
    -c:v ffv1 "$work/window.mkv"
wait "$player" || { cat "$work/play.log" >&2; exit 1; }

"$build/examples/play/play" --headless --output "$work" --seconds 9 --window-png "$work/touch.png" \
    "$work/meadow.avi" -- touch=luma touch-relief=20 >"$work/play.log" 2>&1 || { cat "$work/play.log" >&2; exit 1; }
ffmpeg -v error -y -i "$work/touch.png" -filter_complex \
    "split[a][b];[a]palettegen=max_colors=256[p];[b][p]paletteuse=dither=none" "$here/window_touch.png"

cp "$work/window.png" "$here/debug_window.png"
# One palette for all frames; the ordered dither does not flicker, and what rests costs nothing.
ffmpeg -v error -y -i "$work/window.mkv" -filter_complex \
    "scale=900:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=128:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
    "$here/debug_window.gif"
ls -l "$here/debug_window.png" "$here/debug_window.gif" "$here/window_touch.png"
