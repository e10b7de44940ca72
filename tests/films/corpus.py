# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Makes the films of the matrix with ffmpeg, and knows what they show.

A textured square stands on plain ground for the first eight pictures and then moves on a circle to the last one,
so that there is force without a pause from the first picture in which it has moved to the end, and its direction
tells the time. In every other film the picture is mirrored: these are other films with pictures at the same times."""
import hashlib
import json
import math
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from dimensions import CONTAINERS, NAMES, PICTURES, SOUND_TIMES, SOUNDS

PICTURE_COUNT = 40
STANDING = 8  # number of the first picture in which the square has moved
RATE_HZ = 25.0
TURN_RAD = 2 * math.pi / 1.5 / RATE_HZ  # between two pictures
RADIUS_PX = 32
HIDDEN_S = 0.2  # at the beginning, by an edit list
START_S = 2.7
TURNED = "turned by 90"
MS = 0.001
RECIPE = 4  # of the masters: films that were made by another one are made anew


def angle(number):
    return TURN_RAD * max(0, number - STANDING + 1)


@dataclass
class Film:
    kind: dict
    mirrored: bool
    path: Path  # in the corpus
    times_s: list  # when each picture is shown, by ffprobe
    cut_bytes: int  # where it is cut off
    streams: list  # "video", "audio", ...

    def number_at(self, after_s):
        """Of the picture that is shown so long after the first one."""
        return self.numbers[0] + round(after_s * (24000 / 1001 if self.kind["times"] == "23.976" else RATE_HZ))

    @property
    def numbers(self):
        """Of the pictures that are shown, in the order in which they were drawn."""
        if self.kind["times"] == "variable rate":
            return [n for n in range(PICTURE_COUNT) if n % 3 < 2]
        return list(range(round(HIDDEN_S * RATE_HZ) if self.kind["times"] == "edit list" else 0, PICTURE_COUNT))

    def direction(self, number):
        """In which direction the square has moved in picture `number` as players show it: x right, y up, length 1."""
        phase = angle(number) - TURN_RAD / 2
        x, y = math.sin(phase) * (-1 if self.mirrored else 1), -math.cos(phase)
        return (y, -x) if self.kind["extra"] == TURNED else (x, y)  # clockwise

    @property
    def sound_goes_on(self):
        """So long after the pictures that it would take the test's time."""
        return SOUND_TIMES[self.kind["sound time"]][1] > 1

    def __str__(self):
        return ", ".join(value for value in self.kind.values())


class NoEncoder(Exception):
    """This ffmpeg cannot make such a film."""


def run(command):
    done = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
    said = done.stderr.decode(errors="replace").strip()
    if done.returncode and (unknown := re.search("Unknown encoder '.*'", said)):
        raise NoEncoder(f"ffmpeg: {unknown[0]}")
    if done.returncode:
        raise RuntimeError(f"{command}: {said}")
    return done.stdout


def ffmpeg(*arguments):
    run(["ffmpeg", "-nostdin", "-v", "error", "-y", "-threads", "1", *arguments])


def masters(folder):
    """The pictures without loss, plain and mirrored, and what films have beside pictures and sound. The noise keeps
    encoders from leaving out the pictures in which nothing moves."""
    square = ("geq=lum='128+96*sin(9999*sin(12.9898*floor(X/6)+78.233*floor(Y/6)))':cb=128:cr=128"
              ",format=yuv420p")
    moved = f"{TURN_RAD}*max(0,n-{STANDING - 1})"
    size = f"r={RATE_HZ:g}:d={PICTURE_COUNT / RATE_HZ}"
    for name, way in (("plain", ""), ("mirrored", ",hflip")):
        ffmpeg("-f", "lavfi", "-i",
               f"color=0x707070:s=192x144:{size},format=yuv420p[g];nullsrc=s=64x64:{size},{square}[s];"
               f"[g][s]overlay=x='64-{RADIUS_PX}*cos({moved})':y='40+{RADIUS_PX}*sin({moved})':"
               f"eval=frame{way},noise=alls=5:allf=t:all_seed=1",
               "-c:v", "ffv1", folder / f"{name}.mkv")
    ffmpeg("-f", "lavfi", "-i", "color=red:s=64x64", "-frames:v", "1", folder / "poster.png")
    (folder / "text.srt").write_text("1\n00:00:00,200 --> 00:00:01,000\nA square moves.\n")
    ffmpeg("-i", folder / "text.srt", folder / "text.ass")
    (folder / "chapters.txt").write_text(
        ";FFMETADATA1\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=800\ntitle=one\n"
        "[CHAPTER]\nTIMEBASE=1/1000\nSTART=800\nEND=1600\ntitle=two\n")


def arguments(kind, master, common):
    """Those of ffmpeg, without the output."""
    begins_s, longer_s = SOUND_TIMES[kind["sound time"]]
    rate = ["-r", "24000/1001"] if kind["times"] == "23.976" else []
    duration_s = PICTURE_COUNT / (24000 / 1001 if rate else RATE_HZ)
    inputs = [*(["-itsoffset", -begins_s] if begins_s < 0 else []), *rate, "-i", master]
    maps, output = ["-map", "0:v"], []

    def add(*options):
        maps.extend(["-map", inputs.count("-i")])
        inputs.extend(options)

    if kind["sound"] != "none":
        # From 0 on: before the pictures if these are later.
        length_s = duration_s + longer_s - begins_s
        sine = ["-f", "lavfi", "-t", f"{length_s}", "-i", "sine=r=48000"]
        add(*(["-itsoffset", begins_s] if begins_s > 0 else []), *sine)
        output += [*SOUNDS[kind["sound"]].split(), "-ac", "2", "-strict", "-2"]
    extra = kind["extra"]
    if extra == "second video":
        maps += ["-map", "0:v"]
    elif extra in ("SRT", "ASS"):
        add("-i", common / f"text.{extra.lower()}")
        output += ["-c:s", "copy"]
    elif extra == "chapters":
        inputs += ["-i", common / "chapters.txt"]
        output += ["-map_metadata", inputs.count("-i") - 1]
    poster = extra == "poster" and CONTAINERS[kind["container"]][1] != "mkv"
    if poster:
        add("-i", common / "poster.png")
    elif extra == "poster":
        output += ["-attach", common / "poster.png", "-metadata:s:t", "mimetype=image/png"]
    video = PICTURES[kind["pictures"]].replace("-c:v", "-c:v:0" if poster else "-c:v").split()
    if poster:
        video += ["-c:v:1", "copy", "-disposition:v:1", "attached_pic"]
    video += ["-fps_mode", "passthrough"]  # no picture twice where the pictures begin later
    if kind["times"] == "variable rate":
        video += ["-filter:v:0" if poster else "-filter:v", "select=lt(mod(n\\,3)\\,2)"]
    elif kind["times"] == "from 2.7 s":
        output += ["-output_ts_offset", START_S]
    return [*inputs, *maps, *video, *output]


def turn(film, copied):
    """Copies the film so that it is shown turned by 90 degrees clockwise. Newer releases of ffmpeg have
    -display_rotation in place of rotate=270, which ffmpeg 5.1 follows only when it copies."""
    try:
        ffmpeg("-display_rotation", -90, "-i", film, *copied)
    except RuntimeError:
        ffmpeg("-i", film, "-metadata:s:v:0", "rotate=270", *copied)


def encode(kind, master, common, to):
    muxer = CONTAINERS[kind["container"]][0].split()
    whole = to.with_name("whole" + to.suffix)
    copied = ["-map", "0:v", "-map", "0:a?", "-c", "copy", "-strict", "-2", *muxer, to]
    ffmpeg(*arguments(kind, master, common), *muxer, to)
    if kind["times"] == "edit list":
        ffmpeg("-ss", HIDDEN_S, "-i", to.rename(whole), *copied)
    if kind["extra"] == TURNED:
        turn(to.rename(whole), copied)
    whole.unlink(missing_ok=True)


def probed(path, entries):
    return json.loads(run(["ffprobe", "-v", "error", "-show_entries", entries, "-of", "json", path]))


def look_into(kind, path):
    """When the pictures are shown by a player that obeys the edit list, where the film is cut off, and its streams."""
    found = probed(path, "stream=index,codec_type:stream_side_data=rotation:packet=codec_type,pos,size"
                         ":frame=stream_index,best_effort_timestamp_time")
    streams, mixed = found["streams"], found["packets_and_frames"]
    video = next(stream for stream in streams if stream["codec_type"] == "video")
    if kind["extra"] == TURNED and (turned := video["side_data_list"][0]["rotation"]) != -90:
        raise RuntimeError(f"ffmpeg has turned {path} by {turned} degrees counterclockwise")
    fps = 24000 / 1001 if kind["times"] == "23.976" else RATE_HZ
    frames = [item for item in mixed if item["type"] == "frame" and item["stream_index"] == video["index"]]
    # AVI counts pictures; ffprobe gives some of them no time.
    times = sorted(float(frame.get("best_effort_timestamp_time", i / fps)) for i, frame in enumerate(frames))
    packets = [item for item in mixed if item["type"] == "packet" and item["codec_type"] == "video" and "pos" in item]
    first = min(packets, key=lambda packet: int(packet["pos"]))
    half = path.stat().st_size // 2
    cut_bytes = {"half": half, "5 kB": 5000, "after the first picture": int(first["pos"]) + int(first["size"])}
    return [time for time in times if time > -MS], min(half, cut_bytes[kind["cut"]]), [s["codec_type"] for s in streams]


def make(kind, mirrored, folder):
    """The film of this kind, from `folder` if it is there."""
    master = folder / ("mirrored.mkv" if mirrored else "plain.mkv")
    what = {name: value for name, value in kind.items() if name not in ("player", "tool")}
    recipe = str([RECIPE, what, mirrored, arguments(kind, master.name, Path()), CONTAINERS[kind["container"]]])
    place = folder / hashlib.sha1(recipe.encode()).hexdigest()[:12]
    path, facts = place / (NAMES[kind["name"]] + "." + CONTAINERS[kind["container"]][1]), place / "facts.json"
    if not facts.exists():
        place.mkdir(exist_ok=True)
        encode(kind, master, folder, path)
        facts.write_text(json.dumps(look_into(kind, path)))
    return Film(kind, mirrored, path, *json.loads(facts.read_text()))
