#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Compares the force of variants of a film with that of the plain film. pathologies.py BUILD [CLIP|FOLDER...] makes the
variants with ffmpeg, plays them through the spidarmotion of a meson build folder, and prints a table with a row for each.

Without a CLIP the films are made, too: one with a moving object in front of a pan, and the pan alone. A CLIP is
something that ffmpeg reads, with one shot of two seconds or more; a FOLDER is as for real_films.py.

strength: root mean square of the force, over that of the plain film. angle: between the two curves of force, as vectors
over time. steps: root mean square of the change of force in a millisecond, over that of the plain film. rest: largest
force, N, where none belongs: in films without an object, in a freeze. Within: strength 0.9 … 1.1 and angle below 10
degrees, both beyond what coding the film at crf 17 … 23 does to it; steps at most 1.5; rest below 2 mN. In strength,
angle and steps the first half second, in which the rhythm of the frames is learnt, and the time of a fade and three
frames after it are not counted; in rest they are.

The plain film of drawings on twos is that of every second picture, of a telecined film the film, of an interlaced one
with two pictures in a frame that of every second picture, of a ramp of speed the ramp by timestamps."""

import array
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from pathology_films import LOSSLESS, RATE, SETTLED_S, SKIPPED_S, ffmpeg, make_films, variants, x264
from real_films import films_of

PROFILES = Path(__file__).resolve().parents[2] / "spidar" / "profiles" / "shipped"
SAMPLE_S = 0.001
CHANNELS = 6
FULL_SCALE_N = 10
STRENGTH, ANGLE, STEPS, REST_N = 0.1, 10, 1.5, 0.002


class Player:
    """Plays films through the element and returns their force at each millisecond."""

    def __init__(self, build, folder):
        self.environment = dict(os.environ, GST_PLUGIN_PATH=str(build / "plugin"),
                                GST_REGISTRY=str(folder / "registry"))
        self.environment.setdefault("SPIDAR_PROFILE_PATH", str(PROFILES))
        self.samples = folder / "force.f32"

    def force(self, film, behind_decoder=""):
        subprocess.run(
            ["gst-launch-1.0", "-q", "filesrc", f"location={film}", "!", "decodebin", "!",
             *behind_decoder.split(), "spidarmotion", "device=none", "post-messages=false",
             "attach-meta=true", "!", "spidarextract", "name=x", "x.wrench", "!", "filesink",
             f"location={self.samples}"],
            env=self.environment, check=True, stdout=subprocess.DEVNULL)
        values = array.array("f", self.samples.read_bytes())
        return [tuple(FULL_SCALE_N * v for v in values[i:i + 3])
                for i in range(0, len(values), CHANNELS)]


def freeze(folder, film, player, length_s):
    """A second in which the picture stands, then the film goes on."""
    middle = length_s / 2
    at = round(middle * RATE)
    out = folder / "variant.mkv"
    ffmpeg("-i", film, "-vf", f"loop=loop={RATE}:size=1:start={at},setpts=N/{RATE}/TB", *LOSSLESS, out)
    force = player.force(out)
    moved = [round(1000 * (at + RATE) / RATE), round(1000 * at / RATE)]
    shifted = force[:moved[1]] + force[moved[0]:]
    still = force[moved[1] + 150:moved[0] - 60]
    return shifted, [(SKIPPED_S, middle - 0.05), (middle + SETTLED_S, length_s)], still


def cuts(folder, film, player, plain, length_s):
    """Shots of a second, in turns from the film and its mirror image."""
    mirror, out = folder / "mirror.mkv", folder / "variant.mkv"
    ffmpeg("-i", film, "-vf", "hflip", *LOSSLESS, mirror)
    ffmpeg("-i", film, "-i", mirror, "-filter_complex",
           f"[0][1]blend=all_expr='if(lt(mod(T,2),1),A,B)'", *LOSSLESS, out)
    mirrored = player.force(mirror)
    expected = [(a if (t // 1000) % 2 == 0 else b) for t, (a, b) in enumerate(zip(plain, mirrored))]
    spans = [(max(k, SKIPPED_S) + SETTLED_S, k + 1 - 0.05) for k in range(math.floor(length_s))]
    return player.force(out), expected, spans


def dissolve(folder, film, player, plain, length_s):
    mirror, out = folder / "mirror.mkv", folder / "variant.mkv"
    middle, fade_s = length_s / 2, 0.5
    ffmpeg("-i", film, "-i", mirror, "-filter_complex",
           f"[0][1]blend=all_expr='A+(B-A)*clip((T-{middle - fade_s})/{fade_s},0,1)'", *LOSSLESS, out)
    mirrored = player.force(mirror)
    expected = [(a if t < 1000 * middle else b) for t, (a, b) in enumerate(zip(plain, mirrored))]
    return player.force(out), expected, [(SKIPPED_S, middle - fade_s - 0.05), (middle + SETTLED_S, length_s)]


def norm(v):
    return math.sqrt(sum(x * x for x in v))


def compare(force, plain, spans):
    """strength, angle in degrees, steps."""
    ff = pp = fp = steps = plain_steps = 0.0
    for begin_s, end_s in spans:
        first, end = round(begin_s / SAMPLE_S), min(round(end_s / SAMPLE_S), len(force), len(plain))
        for i in range(max(first, 1), end):
            f, p = force[i], plain[i]
            ff += sum(x * x for x in f)
            pp += sum(x * x for x in p)
            fp += sum(x * y for x, y in zip(f, p))
            steps += sum((x - y) ** 2 for x, y in zip(f, force[i - 1]))
            plain_steps += sum((x - y) ** 2 for x, y in zip(p, plain[i - 1]))
    if pp == 0 or ff == 0:
        return 0.0, 180.0, 0.0
    angle = math.degrees(math.acos(max(-1.0, min(1.0, fp / math.sqrt(ff * pp)))))
    return math.sqrt(ff / pp), angle, math.sqrt(steps / plain_steps)


def span_of_encodes(film, player, out, plain, spans):
    """What usual coding does to strength and angle."""
    strength = angle = 0.0
    for crf in (17, 20, 23):
        ffmpeg("-i", film, *x264(crf), out)
        compared = compare(player.force(out), plain, spans)
        strength = max(strength, abs(compared[0] - 1))
        angle = max(angle, compared[1])
    return strength, angle


class Table:
    def __init__(self):
        self.rows = self.within = 0
        self.strength, self.angle = STRENGTH, ANGLE

    def begin(self, name):
        self.strength, self.angle = STRENGTH, ANGLE
        print(f"\n### {name}\n")
        print("| | film | strength | angle | steps | rest, N | |\n|---|---|---|---|---|---|---|", flush=True)

    def add(self, variant_group, name, compared=None, rest_N=None):
        cells = ["", "", ""]
        fits = True
        if compared:
            strength, angle, steps = compared
            cells = [f"{strength:.2f}", f"{angle:.0f}", f"{steps:.2f}"]
            fits = abs(strength - 1) <= self.strength and angle < self.angle and steps <= STEPS
        if rest_N is not None:
            fits = fits and rest_N < REST_N
        cells.append("" if rest_N is None else f"{rest_N:.3f}")
        self.rows += 1
        self.within += fits
        print("|", " | ".join([variant_group, name, *cells, "" if fits else "**outside**"]), "|", flush=True)


def probe(film):
    """Width, height and length in seconds."""
    out = subprocess.run(
        ["ffprobe", "-v", "error", "-select_streams", "v:0", "-count_packets", "-show_entries",
         "stream=width,height,nb_read_packets", "-of", "csv=p=0", film],
        check=True, capture_output=True, text=True).stdout.strip().split(",")
    return int(out[0]), int(out[1]), int(out[2]) / RATE


def measure(name, film, player, folder, table):
    width, height, length_s = probe(film)
    plain = player.force(film)
    counted = plain[round(SKIPPED_S / SAMPLE_S):]
    has_object = max(map(norm, counted), default=0) > 0.05
    table.begin(f"{name}: {width}×{height}, {length_s:.1f} s, "
                + (f"{math.sqrt(sum(norm(f) ** 2 for f in counted) / len(counted)):.2f} N rms"
                   if has_object else "only the camera moves"))
    whole = [(SKIPPED_S, length_s - 0.1)]
    out = folder / "variant.mkv"

    if has_object:
        strength, angle = span_of_encodes(film, player, out, plain, whole)
        table.strength += strength
        table.angle += angle
        table.add("coding", "crf 17 … 23, at most", (1 + strength, angle, 1))

    def add(group, title, force, expected, spans):
        if has_object:
            table.add(group, title, compare(force, expected, spans))
        else:
            table.add(group, title, rest_N=max(map(norm, force)))

    for variant in variants(length_s):
        variant.filters = variant.filters.replace("{w}", str(width)).replace("{h}", str(height))
        variant.make(film, out)
        expected = plain
        if variant.plain and has_object:
            other = folder / "plain.mkv"
            ffmpeg("-i", film, "-vf", variant.plain, "-fps_mode", "vfr", *LOSSLESS, other)
            expected = player.force(other)
        add(variant.group, variant.name, player.force(out, variant.behind), expected,
            variant.spans or whole)
    shifted, spans, still = freeze(folder, film, player, length_s)
    table.add("editing", "frozen for a second",
              compare(shifted, plain, spans) if has_object else None, rest_N=max(map(norm, still)))
    for title, make in (("cuts", cuts), ("dissolve", dissolve)):
        force, expected, spans = make(folder, film, player, plain, length_s)
        add("editing", title, force, expected, spans)


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: pathologies.py BUILD [CLIP|FOLDER...]")
    for tool in ("ffmpeg", "ffprobe", "gst-launch-1.0"):
        if not shutil.which(tool):
            sys.exit(f"pathologies.py: needs {tool}")
    build = Path(sys.argv[1]).resolve()
    table = Table()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        player = Player(build, folder)
        clips = [clip for given in map(Path, sys.argv[2:]) for clip in (films_of([given]) if given.is_dir() else [given])]
        films = []
        for clip in clips:
            film = folder / f"plain-{clip.stem}.mkv"
            ffmpeg("-i", clip, "-an", "-vf", f"setpts=N/{RATE}/TB,scale=in_range=auto:out_range=tv,format=yuv420p",
                   "-r", RATE, *LOSSLESS, film)
            films.append((clip.stem, film))
        for film in [] if clips else make_films(folder):
            films.append((f"made: {film.stem}", film))
        for title, film in films:
            measure(title, film, player, folder, table)
    print(f"\n{table.within} of {table.rows} within.")


main()
