# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A film in a folder of its own, what the programs make of it, and what was found in what they wrote."""
import bisect
import collections
import json
import os
import select
import shutil
import struct
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from corpus import MS

FULL_SCALE_N = 10
SLOWEST_S = 400  # of a command that does not hang
MOST_HANGS = 3
PLAYBIN3 = ("playbin3", "gapless")  # players that are one


def read_samples(wav):
    """The force of each millisecond, N, from a WAV file of floating-point numbers."""
    data = wav.read_bytes()
    begin = data.index(b"data") + 8
    count = (len(data) - begin) // 24
    values = struct.unpack_from(f"<{6 * count}f", data, begin)
    return [(FULL_SCALE_N * values[i], FULL_SCALE_N * values[i + 1]) for i in range(0, len(values), 6)]


def environment():
    """With criticals that are not fatal: GStreamer's own are found in what is printed."""
    return {name: value for name, value in os.environ.items() if name != "G_DEBUG"}


@dataclass
class Outcome:
    status: int
    text: str

    def __bool__(self):
        return self.status == 0


class Player:
    """A process of player.py, which is started again after it has crashed."""

    def __init__(self):
        self.process, self.log, self.hangs = None, tempfile.TemporaryFile(), collections.Counter()

    def play(self, play):
        """What player.py prints; criticals are warnings. A playbin3 of GStreamer 1.22 hangs in some plays, or ends them
        without a picture (4 of 60 of an FLV film), without our element, too: only what does so each time is an error. A
        crash always is one."""
        for _ in range(MOST_HANGS):
            result = self.play_once(play)
            shows_nothing = play["player"] in PLAYBIN3 and not result["frames"]
            self.hangs[play["player"]] += result["hung"] or shows_nothing
            if not (result["hung"] and result["error"] or shows_nothing):
                break
        return result

    def play_once(self, play):
        if not self.process:
            self.process = subprocess.Popen([sys.executable, Path(__file__).with_name("player.py")], text=True,
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log,
                                            env=environment())
        self.log.truncate(0)
        self.log.seek(0)
        self.process.stdin.write(json.dumps(play) + "\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], SLOWEST_S)[0]:
            self.process.kill()
        answer = self.process.stdout.readline()
        self.log.seek(0)
        said = self.log.read().decode(errors="replace").strip()
        if not answer:
            status, self.process = self.process.wait(), None
            raise RuntimeError(f"{play['player']} ended with status {status}: {said[-300:]}")
        result = json.loads(answer)
        if result["hung"]:  # then it has ended
            self.process.communicate()
            self.process = None
        result["warnings"] += [line for line in said.splitlines() if "CRITICAL" in line]
        return result

    def close(self):
        if self.process:
            self.process.communicate()


@dataclass
class Trial:
    film: object
    other: object  # a film with other pictures, at the same times
    folder: Path
    programs: dict  # spidartrack, spidar-feel
    player: Player
    plays: dict = field(default_factory=dict)

    def __post_init__(self):
        self.path = self.copy(self.film, ".")
        self.track = self.path.with_name(self.path.name + ".haptic.flac")
        self.samples = None

    def copy(self, film, folder, name=None):
        (self.folder / folder).mkdir(exist_ok=True)
        path = self.folder / folder / (name or film.path.name)
        shutil.copy(film.path, path)
        return path

    def run(self, *command):
        try:
            done = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=SLOWEST_S, env=environment())
        except subprocess.TimeoutExpired:
            return Outcome(-1, f"still running after {SLOWEST_S} s")
        text = done.stdout.decode(errors="surrogateescape").strip()
        return Outcome(done.returncode, text + (f" (signal {-done.returncode})" if done.returncode < 0 else ""))

    def spidartrack(self, *arguments):
        return self.run(self.programs["spidartrack"], *arguments)

    def play_quickly(self, player, film, properties=None):
        """As fast as the machine can."""
        play = {"player": player, "film": str(film)}
        return self.player.play({**play, "properties": properties} if properties else play)

    def look(self):
        """What every player shows, and the force of each picture."""
        forces = self.folder / "forces.jsonl"
        analyse = {"device": "none", "trace": str(forces)}
        own = self.film.kind["player"]
        for player in ("playbin", "decodebin", *(["playbin3"] if own in ("playbin3", "gapless") else [])):
            self.plays[player] = self.play_quickly(player, self.path, analyse if player == "decodebin" else None)
        with open(forces, encoding="utf-8") as lines:
            rows = [json.loads(line) for line in lines]
        self.forces = [(1e-9 * row["stream_time_ns"], *row["wrench"]["force_N"][:2]) for row in rows]
        self.intervals_s = [1e-9 * row["interval_ns"] for row in rows]  # in which their motion happened
        forces.unlink()
        if not self.forces:
            raise RuntimeError(f"no picture is analysed: {self.plays['decodebin']['error']}")
        self.numbers = [self.film.number_at(force[0] - self.forces[0][0]) for force in self.forces]

    def force_at(self, stream_s):
        """That of the track, N, at this time; nothing after its end."""
        place = stream_s / MS
        at = int(place)
        if at + 1 >= len(self.samples):
            return (0.0, 0.0)
        return tuple(a + (place - at) * (b - a) for a, b in zip(self.samples[at], self.samples[at + 1]))

    def play_in_time(self, player):
        """In real time, with a trace of what is felt. Stops where only sound is left, except in the middle of two."""
        ticks = self.folder / "ticks.csv"
        properties = {"haptic-trace": str(ticks), **({"track": "auto"} if player == "track=auto" else {})}
        play = {"player": "playbin" if player == "track=auto" else player, "film": str(self.path),
                "properties": properties, "ticks": str(ticks), "pictures": len(self.forces)}
        if player != "gapless" and self.film.sound_goes_on:
            play["until_s"] = self.plays["playbin"]["frames"][-1][1]
        try:
            result = self.player.play(play)
        finally:
            ticks.unlink(missing_ok=True)
        if result["error"]:
            raise RuntimeError(f"{player}: {result['error']}")
        return result

    def feel_gst_play(self):
        ticks = self.folder / "ticks.csv"
        outcome = self.run(self.programs["spidar-feel"], f"haptic-trace={ticks}", "device=sim", "--",
                           "gst-play-1.0", "--quiet", "--no-interactive", "--audiosink=fakesink sync=true",
                           "--videosink=queue max-size-buffers=8 ! fakesink sync=true",
                           self.path)
        if not outcome:
            raise RuntimeError(f"gst-play-1.0 ended with status {outcome.status}: {outcome.text[-300:]}")
        from player import read_ticks
        result = {"frames": self.plays["playbin"]["frames"], "ticks": list(read_ticks(ticks)), "warnings": []}
        ticks.unlink()
        return result


class Screen:
    """Which picture of a film is on the screen when, from what a player has shown."""

    def __init__(self, frames):
        self.stream_s, self.due_s = zip(*frames)

    def stream_at(self, running_s):
        """Stream time; nothing before the first picture."""
        at = bisect.bisect_right(self.due_s, running_s) - 1
        return None if at < 0 else self.stream_s[at] + running_s - self.due_s[at]
