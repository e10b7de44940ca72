#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""examples/lsl.py with a film on the simulated device, and a stand-in for the outlets of pylsl, which Debian does not have.

    test_lsl.py EXAMPLES
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

EXAMPLES = Path(sys.argv.pop(1) if len(sys.argv) > 1 else "examples")
sys.path.insert(0, str(EXAMPLES))

import lsl  # noqa: E402

# What the stand-in is told, a line of JSON for each: name of the stream, sample, stamp.
STAND_IN = '''
import json, os
IRREGULAR_RATE, cf_double64, cf_string = 0.0, 2, 3
class Node:
    def append_child(self, name): return Node()
    def append_child_value(self, name, value): assert isinstance(value, str)
class StreamInfo:
    def __init__(self, name, type, channel_count, nominal_srate, channel_format, source_id):
        self.name, self.count, self.format = name, channel_count, channel_format
    def desc(self): return Node()
class StreamOutlet:
    out = open(os.environ["LSL_OUT"], "a", buffering=1)
    def __init__(self, info): self.info = info
    def push_sample(self, sample, timestamp):
        assert len(sample) == self.info.count
        assert all(isinstance(each, str if self.info.format == cf_string else float) for each in sample)
        self.out.write(json.dumps([self.info.name, sample, timestamp]) + "\\n")
'''


class Lsl(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.pipe = self.folder / "pipe"

    def start(self):
        (self.folder / "pylsl.py").write_text(STAND_IN)
        environment = os.environ | {"PYTHONPATH": str(self.folder), "LSL_OUT": str(self.folder / "out")}
        program = subprocess.Popen([sys.executable, EXAMPLES / "lsl.py", self.pipe], env=environment)
        self.addCleanup(program.kill)
        until = time.monotonic() + 60
        while not self.pipe.exists() and time.monotonic() < until:
            time.sleep(0.01)
        return program

    def test_a_film_is_streamed_with_the_stamps_of_its_trace(self):
        program = self.start()
        before = time.monotonic()
        subprocess.run(["gst-launch-1.0", "-q", "videotestsrc", "pattern=ball", "num-buffers=30", "!",
                        "video/x-raw,width=320,height=240,framerate=30/1", "!", "spidarmotion", "device=sim",
                        f"haptic-trace={self.pipe}", "!", "fakesink", "sync=true"], check=True)
        self.assertEqual(program.wait(60), 0)
        after = time.monotonic()
        self.assertFalse(self.pipe.exists())
        received = [json.loads(line) for line in (self.folder / "out").read_text().splitlines()]
        ticks = [row for row in received if row[0] == "spidar"]
        frames = [row for row in received if row[0] == "spidar markers"]
        self.assertGreater(len(ticks), 0)
        stamps = [stamp for _, _, stamp in ticks]
        self.assertEqual(stamps, sorted(stamps))
        self.assertTrue(before < stamps[0] and stamps[-1] < after, "CLOCK_MONOTONIC, when the tick began")
        self.assertGreater(max(math.hypot(*sample[:3]) for _, sample, _ in ticks), 0.04)
        for _, sample, _ in ticks:
            self.assertAlmostEqual(math.hypot(*sample[9:]), 1, 6, "an orientation")
        texts = [sample[0] for _, sample, _ in frames]
        self.assertGreater(len(texts), 0)
        self.assertEqual(len(texts), len(set(texts)), "each frame once")
        for text, (_, _, stamp) in zip(texts, frames):
            self.assertRegex(text, r"^frame \d+$")
            self.assertIn(stamp, stamps)

    def test_says_what_is_missing(self):
        (self.folder / "pylsl.py").write_text("raise RuntimeError('no liblsl')")
        done = subprocess.run([sys.executable, EXAMPLES / "lsl.py", self.pipe], env={"PYTHONPATH": str(self.folder)},
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, "no liblsl; install pylsl" in done.stderr), (1, True), done)
        self.assertFalse(self.pipe.exists())

    def test_units_are_those_of_the_channels(self):
        for name in lsl.CHANNELS:
            unit = next(unit for kind, unit in lsl.UNITS.items() if kind in name)
            self.assertTrue(name.endswith("_" + unit) if unit else name.startswith("orientation"), name)


if __name__ == "__main__":
    unittest.main()
