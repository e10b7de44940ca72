#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Makes the pictures of the debug window, without a screen, and the README's: `meson compile -C build screenshots`, or
#   docs/figures/screenshots.sh BUILD
# Writes debug_window.png, window_touch.png, show.gif and screen.png into its own folder. Needs ffmpeg, xvfb, xdotool,
# chromium, python3-numpy, gstreamer1.0-libav (MJPEG), an H.264 encoder (gstreamer1.0-plugins-bad or -ugly) and
# fonts-dejavu-core.
set -euo pipefail
build=$(realpath "${1:?usage: docs/figures/screenshots.sh BUILD}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
size=1280x800

work=$(mktemp -d)
server=
browser=
end() {
    [[ -z $browser ]] || kill -- -"$browser" 2>/dev/null || true
    [[ -z $server ]] || kill "$server" 2>/dev/null || true
    sleep 1
    rm -rf "$work"
}
trap end EXIT

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
one_palette="split[a][b];[a]palettegen=max_colors=256[p];[b][p]paletteuse=dither=none"
ffmpeg -v error -y -i "$work/touch.png" -filter_complex "$one_palette" "$here/window_touch.png"

# The second period: in the first one, the curve begins. One palette for all frames; what rests costs nothing.
"$build/plugin/spidartrack" show "$work/meadow.avi" "$work/meadow.mp4"
ffmpeg -v error -y -ss 6 -t 6 -i "$work/meadow.mp4" -filter_complex \
    "fps=12,scale=640:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=128:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
    "$here/show.gif"

# A page with that film by a camera in a hand, which moves by fractions of a pixel and has noise, and what is felt of it.
ffmpeg -v error -i "$work/meadow.avi" -c:v libvpx -b:v 8M -deadline realtime -cpu-used 8 -pix_fmt yuv420p \
    -vf "scale=2544:1440,crop=2160:1215:192+150*sin(t*2.1):112+80*sin(t*1.3),scale=528:296,noise=alls=8:allf=t" "$work/film.webm"
cat >"$work/page.html" <<'PAGE'
<!doctype html><meta charset=utf-8><title>Films</title><style>body { margin: 0; font: 15px "DejaVu Sans" }
video { display: block; margin: 16px } header { background: #25406b; color: #fff; padding: 10px 16px } p, h3 { margin: 8px 16px }</style>
<header>Films</header><video src=film.webm muted loop></video><h3>A ball on a meadow</h3><p>36 seconds · 480 lines</p>
<script>for (let n = 1; n < 30; ++n) document.body.append(Object.assign(document.createElement("p"), {
    textContent: "Viewer " + n + " writes what readers read below films." }));
setTimeout(() => document.querySelector("video").play(), 3000)</script>
PAGE
HOME=$work setsid chromium --no-sandbox --test-type --disable-gpu --no-first-run --user-data-dir="$work/profile" --window-position=0,0 \
    --window-size=560,720 --autoplay-policy=no-user-gesture-required "--app=file://$work/page.html" >/dev/null 2>&1 &
browser=$!
until page=$(xdotool search --onlyvisible --name Films); do sleep 0.5; done
"$build/plugin/spidar-feel" device=sim --screen=Films 2>"$work/feel.log" &
feel=$!
until window=$(xdotool search --onlyvisible --class spidar-window); do sleep 0.5; done
xdotool windowsize --sync "$page" 560 720 windowmove "$window" 560 0 windowsize "$window" 720 720 mousemove 1279 799
until grep -q "a film is in it" "$work/feel.log"; do sleep 0.5; done
sleep 5
ffmpeg -v error -y -f x11grab -video_size 1280x720 -i "$DISPLAY" -frames:v 1 "$work/screen.png"
kill "$feel"
ffmpeg -v error -y -i "$work/screen.png" -filter_complex "${one_palette/256/64}" "$here/screen.png"
ls -l "$here"/{debug_window,window_touch,screen}.png "$here/show.gif"
