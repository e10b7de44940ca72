#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""examples/lsl.py with a film on the simulated device: by an inlet of pylsl where it is installed, which Debian does not
have, else by a stand-in for its outlets.

    test_lsl.py EXAMPLES
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import threading
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
        self.pipe, self.received = self.folder / "pipe", []

    def start(self):
        """The program, and a thread that receives."""
        environment = dict(os.environ)
        try:
            import pylsl
        except (ImportError, RuntimeError):
            (self.folder / "pylsl.py").write_text(STAND_IN)
            environment |= {"PYTHONPATH": str(self.folder), "LSL_OUT": str(self.folder / "out")}
            pylsl = None
        program = subprocess.Popen([sys.executable, EXAMPLES / "lsl.py", self.pipe], env=environment)
        self.addCleanup(program.kill)
        inlets = []
        if pylsl:
            for name in "spidar", "spidar markers":
                inlets.append(pylsl.StreamInlet(pylsl.resolve_byprop("name", name, 1, 30)[0]))
                inlets[-1].open_stream(30)
        until = time.monotonic() + 30
        while not self.pipe.exists() and time.monotonic() < until:
            time.sleep(0.01)
        return program, inlets

    def take(self, inlets):
        """What comes until nothing comes any more."""
        for inlet in inlets:
            name = inlet.info().name()
            while (sample := inlet.pull_sample(1.0))[0] is not None:
                self.received.append([name, *sample])

    def test_a_film_is_streamed_with_the_stamps_of_its_trace(self):
        program, inlets = self.start()
        readers = [threading.Thread(target=self.take, args=([inlet],)) for inlet in inlets]
        before = time.monotonic()
        for reader in readers:
            reader.start()
        subprocess.run(["gst-launch-1.0", "-q", "videotestsrc", "pattern=ball", "num-buffers=30", "!",
                        "video/x-raw,width=320,height=240,framerate=30/1", "!", "spidarmotion", "device=sim",
                        f"haptic-trace={self.pipe}", "!", "fakesink", "sync=true"], check=True)
        self.assertEqual(program.wait(30), 0)
        for reader in readers:
            reader.join()
        after = time.monotonic()
        self.assertFalse(self.pipe.exists())
        if not inlets:
            self.received = [json.loads(line) for line in (self.folder / "out").read_text().splitlines()]
        ticks = [row for row in self.received if row[0] == "spidar"]
        frames = [row for row in self.received if row[0] == "spidar markers"]
        self.assertGreater(len(ticks), 100)
        stamps = [stamp for _, _, stamp in ticks]
        self.assertEqual(stamps, sorted(stamps))
        self.assertTrue(before < stamps[0] and stamps[-1] < after, "CLOCK_MONOTONIC, when the tick began")
        self.assertGreater(max(math.hypot(*sample[:3]) for _, sample, _ in ticks), 0.04)
        for _, sample, _ in ticks:
            self.assertAlmostEqual(math.hypot(*sample[9:]), 1, 6, "an orientation")
        texts = [sample[0] for _, sample, _ in frames]
        self.assertGreater(len(texts), 5)
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
