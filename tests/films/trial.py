# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A film in a folder of its own, what the programs make of it, and what was found in what they wrote."""
import csv
import json
import os
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

FULL_SCALE_N = 10
QUICK_PLAYERS = ("playbin", "playbin3", "decodebin")
PLAY_FILM = Path(__file__).with_name("play_film.py")
SLOWEST_S = 100  # of a command that does not hang


@dataclass
class Outcome:
    status: int
    text: str

    def __bool__(self):
        return self.status == 0


@dataclass
class Trial:
    film: object
    other: object  # a film with other pictures, at the same times
    folder: Path
    programs: dict  # spidartrack, spidar-feel
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

    def run(self, *command, env=None):
        command = [str(word) for word in command]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  timeout=SLOWEST_S, env={**os.environ, **(env or {})})
        except subprocess.TimeoutExpired:
            return Outcome(-1, f"still running after {SLOWEST_S} s")
        text = done.stdout.decode(errors="surrogateescape").strip()
        return Outcome(done.returncode, text + (f" (signal {-done.returncode})" if done.returncode < 0 else ""))

    def spidartrack(self, *arguments):
        return self.run(self.programs["spidartrack"], *arguments)

    def play(self, *plays):
        """See play_film.py; results are kept under the names of the plays."""
        outcome = self.run(sys.executable, PLAY_FILM, self.folder, *map(json.dumps, plays))
        lines = [line for line in outcome.text.splitlines() if line.startswith("{")]
        if not outcome or not lines:
            raise RuntimeError(f"playing ended with status {outcome.status}: {outcome.text[-300:]}")
        results = json.loads(lines[-1])
        self.plays.update(results)
        return results

    def play_quickly(self, player, film, properties):
        """As fast as the machine can."""
        return self.play({"name": "quick", "player": player, "film": str(film), "properties": properties})["quick"]

    def look(self):
        """What every player shows, and the force of each picture."""
        plays = [{"name": player, "player": player, "film": str(self.path)} for player in QUICK_PLAYERS]
        forces = self.folder / "forces.csv"
        plays.append({"name": "analysed", "player": "decodebin", "film": str(self.path),
                      "properties": {"device": "none", "trace": str(forces)}})
        self.play(*plays)
        with open(forces, newline="") as rows:
            self.forces = [(1e-9 * int(row["stream_time_ns"]), float(row["force_x_N"]), float(row["force_y_N"]))
                           for row in csv.DictReader(rows)]
        forces.unlink()
        self.numbers = [self.film.number_at(force[0] - self.forces[0][0]) for force in self.forces]

    def play_in_time(self, player):
        """In real time, with a trace of what is felt. Stops where only sound is left, except in the middle of two."""
        name = "in time"
        if player == "spidar-feel":
            return self.feel_gst_play()
        play = {"name": name, "player": "playbin" if player == "track=auto" else player, "film": str(self.path),
                "sync": True, "properties": {"track": "auto"} if player == "track=auto" else {}}
        if player != "gapless":
            play["until_s"] = self.plays["playbin"]["frames"][-1][1]
        result = self.play(play)[name]
        if result["error"]:
            raise RuntimeError(result["error"])
        return result

    def feel_gst_play(self):
        ticks = self.folder / "felt.csv"
        outcome = self.run(self.programs["spidar-feel"], f"haptic-trace={ticks}", "device=sim", "--",
                           "gst-play-1.0", "--quiet", "--no-interactive", "--audiosink=fakesink sync=true",
                           "--videosink=queue max-size-buffers=8 ! fakesink sync=true",
                           self.path)
        if not outcome:
            raise RuntimeError(f"gst-play-1.0 ended with status {outcome.status}: {outcome.text[-300:]}")
        from play_film import read_ticks
        result = {"frames": self.plays["playbin"]["frames"], "ticks": list(read_ticks(ticks)), "warnings": []}
        ticks.unlink()
        return result

    def read_samples(self, wav):
        """The force of each millisecond, N, from a WAV file of floating-point numbers."""
        data = wav.read_bytes()
        begin = data.index(b"data") + 8
        count = (len(data) - begin) // 24
        values = struct.unpack_from(f"<{6 * count}f", data, begin)
        return [(FULL_SCALE_N * values[i], FULL_SCALE_N * values[i + 1]) for i in range(0, len(values), 6)]
