#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Which presentations of the study count: by doctored traces.

    test_study_delivery.py FOLDER-OF-STUDY.PY
"""

import math
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "examples/study"
sys.path.insert(0, FOLDER)

import numpy as np  # noqa: E402

import delivery  # noqa: E402
import preview  # noqa: E402


class Delivery(unittest.TestCase):
    """Traces of a clip of 2 s, 25 frames/s, which asks for 0.3 N rms in x."""
    FRAMES = [[40_000_000 * n, 0.3 * math.sqrt(2) * math.sin(2 * math.pi * n / 25), 0, 0] for n in range(51)]
    LAST_MS = 2000
    STALL_MS = 700  # where the film asks for much

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.ticks, self.frames = Path(folder.name, "ticks"), Path(folder.name, "frames")

    def judge(self, change=lambda tick: tick, is_muted=False, limit="none", others=()):
        """`change`: doctors a tick, or takes it out (None)."""
        names = ["playing", "device", "found", "running_ns", "monotonic_ns",
                 *(f"delivered_force_{axis}_N" for axis in "xyz")]
        force_N = (not is_muted) * delivery.between(self.FRAMES, np.arange(self.LAST_MS + 1) * 1e6)
        ticks = [dict(zip(names, [1, "running", "interpolated", ms * 1_000_000, 10**12 + ms * 1_000_000, *force_N[ms]]))
                 for ms in range(self.LAST_MS + 1)]
        ticks.append(dict(zip(names, [0, "closing", "nothing", 0, 10**12 + (self.LAST_MS + 1) * 1_000_000, 0, 0, 0])))
        rows = [[tick[name] for name in names] for tick in map(change, ticks) if tick]
        for path, lines in (self.ticks, [names, *rows]), (self.frames, [["device_no_force_reason"], [limit], ["none"]]):
            path.write_text("".join(",".join(map(str, line)) + "\n" for line in lines))
        return delivery.judge(self.ticks, self.frames, self.FRAMES, is_muted, others)

    @staticmethod
    def within(begin_ms, end_ms, **values):
        """Doctors the ticks of this part of the clip's time; takes them out without `values`."""
        return lambda tick: (tick | values if values else None) if begin_ms <= tick["running_ns"] / 1e6 < end_ms else tick

    @staticmethod
    def scaled(factor):
        return lambda tick: tick | {"delivered_force_x_N": factor * tick["delivered_force_x_N"]}

    def paused(self, ms):
        """The clip stands still for so long, and no force of it is lost."""
        return lambda tick: tick | {"monotonic_ns": tick["monotonic_ns"] + ms * 1_000_000 *
                                    (tick["running_ns"] >= self.STALL_MS * 1_000_000)}

    def test_counts_what_a_hand_got(self):
        share, problem = self.judge()
        self.assertEqual((round(share, 6), problem), (1, ""))
        share, problem = self.judge(self.scaled(0.9))
        self.assertEqual((round(share, 6), problem), (0.9, ""), "less than a hand notices")
        self.assertEqual(self.judge(is_muted=True), (0, ""), "none was to be felt")
        for change in self.paused(90), self.within(700, 790), self.within(700, 790, delivered_force_x_N=0):
            self.assertEqual(self.judge(change)[1], "", "too short to void a trial")

    def test_a_part_without_force_is_a_part_of_the_clip(self):
        """Whether the device is not playing, has no frame, has no force, or has written nothing."""
        for percent in 20, 50, 80:
            for values in ({"playing": 0, "delivered_force_x_N": 0}, {"found": "expired", "delivered_force_x_N": 0},
                           {"found": "held"}, {"delivered_force_x_N": 0}, {}):
                # In pieces of half a wave, so that it does not matter where the film is strong.
                def doctored(tick, values=values, percent=percent):
                    is_out = tick["playing"] and tick["running_ns"] // 1_000_000 % 500 < 5 * percent
                    return self.within(0, 2001, **values)(tick) if is_out else tick

                share, problem = self.judge(doctored)
                # Where ticks are missing, the last one stands for ten milliseconds more; of 500.
                self.assertAlmostEqual(share, 1 - percent / 100, delta=0.01 + delivery.MOST_AGE_MS / 500)
                self.assertRegex(problem, "of the clip's force was delivered")
        # Where no force is to be felt, of a picture that stands still in between.
        in_pieces = lambda tick: None if tick["playing"] and tick["running_ns"] // 1_000_000 % 100 < 50 else tick
        self.assertEqual(self.judge(in_pieces, is_muted=True), (0, "60 % of the clip was shown"))  # 50 ms, and 10 more

    def test_a_condition_too_weak_to_be_felt_counts(self):
        weak = [[time_ns, 0.03, 0, 0] for time_ns, *_ in self.FRAMES]
        with patch.object(Delivery, "FRAMES", weak):
            self.assertEqual(self.judge(), (1, ""))

    def test_a_stall_voids_a_trial_that_is_otherwise_complete(self):
        for change in (self.paused(110), self.within(700, 815), self.within(700, 815, playing=0),
                       self.within(700, 815, found="held"), self.within(700, 815, delivered_force_x_N=0)):
            share, problem = self.judge(change)
            self.assertGreater(share, 0.89)
            self.assertIn("picture or force stood still for 11", problem)
            self.assertIn("stood still", self.judge(self.paused(110), is_muted=True)[1], "also where none is to be felt")

    def test_does_not_count_what_it_did_not_get(self):
        for problem, change, given in [
                ("85 % of the clip's force", self.scaled(0.85), {}),
                ("-100 % of the clip's force", self.scaled(-1), {}),
                ("a force of 0.360 N rms, and there should be 0.300 N", self.scaled(1.2), {}),
                ("of the device or the playback: vibration", self.scaled(0), {"limit": "vibration"}),
                ("frames were late in 100 %", self.within(0, 2001, found="expired"), {}),
                ("the device was idle in 20 % of the time",
                 lambda tick: tick | {"device": "idle" if tick["running_ns"] // 1_000_000 % 5 == 0 else "running"}, {}),
                ("the device was lost in 100 % of the time", lambda tick: tick | {"device": "lost"}, {}),
                ("the device did not run", lambda tick: tick | {"playing": 0}, {}),
                ("a force of 0.300 N rms, and there should be 0.000 N",
                 lambda tick: tick | {"delivered_force_x_N": 0.3}, {"is_muted": True})]:
            self.assertIn(problem, self.judge(change, **given)[1])

    @staticmethod
    def moved(**shape):
        """Ticks with another force, N, by the clip's time, s, and what it was."""
        def doctored(tick):
            forces = {f"delivered_force_{axis}_N": change for axis, change in shape.items()}
            return tick | {name: change(tick["running_ns"] / 1e9, tick[name]) for name, change in forces.items()}
        return doctored

    def require(self, said, change, **given):
        """That this is said of it, or nothing."""
        problem = self.judge(change, **given)[1]
        self.assertEqual((said in problem, bool(problem)), (True, bool(said)), problem)

    @staticmethod
    def sway(t, hz=1):
        return 0.3 * math.sqrt(2) * math.sin(2 * math.pi * hz * t)

    def test_a_force_at_another_time_does_not_count(self):
        slow, steady = ([[time_ns, force_N(time_ns / 1e9), 0, 0] for time_ns, *_ in self.FRAMES]
                        for force_N in (lambda t: self.sway(t, 0.4), lambda t: 0.3))
        with patch.object(Delivery, "FRAMES", slow):
            for late_ms, said in (80, "80 ms too late"), (60, "60 ms too late"), (-80, "80 ms too early"), (30, ""), (-30, ""):
                self.require(said, self.moved(x=lambda t, _: self.sway(t - late_ms / 1e3, 0.4)))
        with patch.object(Delivery, "FRAMES", steady):  # no lag is to be seen
            self.require("", self.moved(x=lambda t, _: 0.3 + 0.01 * math.sin(31 * t)))

    def test_a_force_in_another_direction_does_not_count(self):
        for degrees, said in (25, "the force was turned by 25°"), (-25, "turned by 25°"), (15, ""), (-15, ""):
            angle = math.radians(degrees)
            self.require(said, self.moved(x=lambda t, _: math.cos(angle) * self.sway(t),
                                          y=lambda t, _: math.sin(angle) * self.sway(t)))

    def test_a_force_that_stands_at_a_level_does_not_count(self):
        """For 150 ms, from the peak on and about it; for 80 ms, as a busy machine does, it counts."""
        for begin_s, end_s, said in ((0.25, 0.4, "stood still for more than 100 ms while it should move"),
                                     (0.175, 0.325, "stood still"), (0.25, 0.33, "")):
            self.require(said, self.moved(x=lambda t, _: self.sway(begin_s if begin_s <= t < end_s else t)))

    def test_a_force_that_stands_at_the_end_of_a_clip_does_not_count(self):
        """After the motion of the last frame, too, where the force goes to rest."""
        trace = self.frames.with_name("preview")
        rows = [(2 * n - 1) * 20_000_000 * (n > 0) + 20_000_000 for n in range(51)]  # frames, half a frame after their motion
        trace.write_text("running_time_ns,force_x_N,force_y_N,force_z_N\n" + "".join(
            f"{time_ns},{force_N},0,0\n" for time_ns, (_, force_N, *_) in zip(rows, self.FRAMES)))
        end_ms = rows[-1] // 1_000_000 + 40  # one frame after the last one, whose motion was half a frame before it
        curve = delivery.between([*self.FRAMES, [end_ms * 1_000_000, 0, 0, 0]], np.arange(end_ms + 1) * 1e6)[:, 0]
        force_at = lambda t: curve[min(round(1000 * t), end_ms)]
        with patch.object(Delivery, "FRAMES", preview.read_trace(trace)), patch.object(Delivery, "LAST_MS", end_ms):
            for length_ms, said in (0, ""), (150, "stood still"), (120, "stood still"), (70, ""):
                self.require(said, self.moved(x=lambda t, _: force_at(min(t, (end_ms - length_ms) / 1000))))

    def test_the_force_of_another_condition_does_not_count(self):
        """As strong, and by its share nearly all that is asked for."""
        other_N = lambda wanted_N: math.copysign(0.577 * math.sqrt(abs(wanted_N)), wanted_N)
        others = [[[time_ns, other_N(force_N), 0, 0] for time_ns, force_N, *_ in self.FRAMES]]
        of_other = self.moved(x=lambda _, wanted_N: other_N(wanted_N))
        self.require("", of_other)
        self.require("", lambda tick: tick, others=others)
        self.require("", self.scaled(0.9), others=others)  # less than a hand notices
        self.require("another condition", of_other, others=others)
        self.require("another condition", self.moved(x=lambda _, own_N: 0.3 * own_N + 0.7 * other_N(own_N)), others=others)
        self.require("", lambda tick: tick, others=[self.FRAMES])  # nobody tells them apart

    def test_a_vibration_that_nobody_asked_for_does_not_count(self):
        for hz in 12, 20, 45, 100, 220, 450:
            buzz = lambda amount_N: self.moved(y=lambda t, own_N: own_N + amount_N * math.sin(2 * math.pi * hz * t))
            self.require("there was a vibration of 0.100 N at ", buzz(0.1))
            self.require("there was a vibration of 0.050 N at ", buzz(0.05), is_muted=True)
            self.require("", buzz(0.03))  # not felt


if __name__ == "__main__":
    unittest.main()
