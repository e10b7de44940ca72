#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Measures what is felt of films that have only a part of their picture, beside what the same films give alone:

  BUILD=FOLDER tests/bench/framed_films.py FOLDER... [--shares 40,60,80] [--frames NAME,...] [--properties area=auto]

A FOLDER holds films that GStreamer can decode. Each is scaled to a share of the width of a picture of 854 x 480 px, put
into its middle or a corner before each of the backgrounds, and coded by x264: `text`, `photo` (the first picture of
another film) and `blur` (that, blurred) rest; in `boxes`, boxes wander around the film; in `ticker`, words run below it.

Of the frames in which the film alone gives a force of 0.1 N: within 30, felt (0.05 N) at an angle below 30 degrees to that;
beyond 60, felt at one above 60. Beside: felt, of the frames in which the film alone gives less. Means over films; films
with fewer than five such frames are left out."""
import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from real_films import films_of, print_head, trace_rows

WIDTH, HEIGHT = 854, 480
PLACES = {"middle": "(W-w)/2:(H-h)/2", "corner": "W-w:0"}
WORDS = "a page has many words and all of them rest while the film goes on and on between them "
WHOLE_N, FELT_N = 0.1, 0.05


def ffmpeg(*options):
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-threads", "1", *options], check=True, stdin=subprocess.DEVNULL)


def even(length):
    return int(length) // 2 * 2


def background(name, other, folder):
    """The inputs of ffmpeg that make a background, and the filters that make [back] of them."""
    words = folder / "words.txt"
    words.write_text("\n".join(WORDS[i % 40:] + WORDS * 2 for i in range(60)))
    write = f"drawtext=textfile={words}"
    text = f"{write}:fontsize=14:line_spacing=4:x=3:y=3"
    page = ["-f", "lavfi", "-i", f"color=white:{WIDTH}x{HEIGHT}:r=24"]
    still = ["-loop", "1", "-framerate", "24", "-i", str(other)]
    if name == "text":
        return page, f"[0:v]{text}[back]"
    if name == "ticker":
        return page, (f"[0:v]{text},drawbox=0:{HEIGHT - 26}:{WIDTH}:26:black:fill,{write}:fontsize=18:fontcolor=white:"
                      f"x=-60*t:y={HEIGHT - 22}[back]")
    if name == "boxes":
        return page + still, (f"[0:v]{text}[page];[1:v]scale={WIDTH}:{HEIGHT},split[s][t];[s]crop=60:40[p];"
                              "[t]crop=50:36[q];[page][p]overlay='mod(90*t,W)':2[one];[one][q]overlay=2:'mod(60*t,H)'[back]")
    return still, f"[0:v]scale={WIDTH}:{HEIGHT}{',gblur=30' if name == 'blur' else ''}[back]"


def put_into_frame(film, share, place, name, other, out):
    w, h = even(WIDTH * share / 100), even(HEIGHT * share / 100)
    inputs, drawn = background(name, other, out.parent)
    graph = (f"{drawn};[{inputs.count('-i')}:v]scale={w}:{h},setsar=1,fps=24[film];"
             f"[back][film]overlay={PLACES[place]}:shortest=1")
    ffmpeg(*inputs, "-i", str(film), "-filter_complex", graph, "-c:v", "libx264", "-preset", "veryfast", "-crf", "20",
           "-pix_fmt", "yuv420p", str(out))


def forces_N(build, film, properties):
    return [row["wrench"]["force_N"][:2] for row in trace_rows(build, film, properties)]


def compare(alone, framed):
    """Per cent within 30 and beyond 60 degrees of the frames that are felt alone, and felt of the others."""
    right = wrong = counted = beside = others = 0
    for a, b in zip(alone, framed):
        size, found = math.hypot(*a), math.hypot(*b)
        if size <= WHOLE_N:
            others += 1
            beside += found > WHOLE_N
            continue
        counted += 1
        if found > FELT_N:
            cosine = (a[0] * b[0] + a[1] * b[1]) / (size * found)
            right += cosine > math.cos(math.radians(30))
            wrong += cosine < math.cos(math.radians(60))
    if counted < 5:
        return None
    return 100 * right / counted, 100 * wrong / counted, 100 * beside / others if others else None


def main():
    build = Path(os.environ.get("BUILD", "build")).resolve()
    parser = argparse.ArgumentParser(usage="tests/bench/framed_films.py FOLDER... [OPTION...]")
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--shares", default="40,60,80")
    parser.add_argument("--frames", default="text,photo,blur,boxes,ticker")
    parser.add_argument("--places", default="middle,corner")
    parser.add_argument("--properties", default="area=auto", help="with spaces between them")
    parser.add_argument("--every", type=int, default=1, help="only each so many-th film")
    parser.add_argument("--verbose", action="store_true", help="each film, too")
    options = parser.parse_args()
    films = films_of(options.folders)[::options.every]
    properties = options.properties.split()
    print_head("share", "picture around it", "place", "within 30° %", "beyond 60° %", "felt where the film gives nothing %")
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        stills, alone = [], []  # of each film: its first picture, and what it gives by itself
        for film in films:
            still = folder / f"{film.stem}.png"
            ffmpeg("-i", str(film), "-frames:v", "1", str(still))
            stills.append(still)
            whole = folder / "whole.mkv"
            ffmpeg("-i", str(film), "-vf", f"scale={WIDTH}:{HEIGHT},setsar=1", "-r", "24", "-c:v", "libx264", "-preset",
                   "veryfast", "-crf", "20", "-pix_fmt", "yuv420p", str(whole))
            alone.append(forces_N(build, whole, []))
        for share in map(int, options.shares.split(",")):
            for name in options.frames.split(","):
                for place in options.places.split(","):
                    rows = []
                    for i, film in enumerate(films):
                        out = folder / "framed.mkv"
                        put_into_frame(film, share, place, name, stills[i - 1], out)
                        found = compare(alone[i], forces_N(build, out, properties))
                        if found:
                            rows.append(found)
                        if options.verbose:
                            print(film.stem, share, name, place, found, file=sys.stderr, flush=True)
                    mean = lambda k: statistics.fmean(row[k] for row in rows if row[k] is not None)
                    print(f"| {share} % | {name} | {place} | {mean(0):.0f} | {mean(1):.0f} | {mean(2):.0f} |", flush=True)


if __name__ == "__main__":
    main()
