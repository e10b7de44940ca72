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

BEGIN_NS = 10**12


def sway(t, hz=1):
    return 0.3 * math.sqrt(2) * math.sin(2 * math.pi * hz * t)


def film(force_N, torque_Nm=lambda t: 0, frame_ms=40):
    """As preview.read_trace() has some 2 s of 25 frames/s, with a force in x and a torque about z by the time in s."""
    times_ms = (0, *range(frame_ms // 2, 2000 - frame_ms, frame_ms), 2000)
    return [[ms * 1_000_000, force_N(ms / 1000), 0, 0, 0, 0, torque_Nm(ms / 1000)] for ms in times_ms]


class Delivery(unittest.TestCase):
    """Traces of a clip that asks for 0.3 N rms in x, once a second to and fro."""
    FRAMES = film(sway)
    LAST_MS = 2000
    STALL_MS = 700

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.ticks, self.frames, self.screen = (Path(folder.name, name) for name in ("ticks", "frames", "screen"))

    def judge(self, change=lambda tick: tick, is_muted=False, limit="none", others=(), screen=lambda row: row):
        """`change`: doctors a tick, `screen`: when a frame was shown; or takes it out (None)."""
        names = ["playing", "device", "found", "acknowledged", "running_ns", "monotonic_ns",
                 *(f"delivered_{name}" for name in delivery.WRENCH)]
        wrenches = (not is_muted) * delivery.between(self.FRAMES, np.arange(self.LAST_MS + 1) * 1e6)
        ticks = [dict(zip(names, [1, "running", "interpolated", 1, ms * 1_000_000, BEGIN_NS + ms * 1_000_000, *wrenches[ms]]))
                 for ms in range(self.LAST_MS + 1)]
        ticks.append(dict(zip(names, [0, "closing", "nothing", 1, 0, BEGIN_NS + (self.LAST_MS + 1) * 1_000_000, *[0] * 6])))
        rows = [[tick[name] for name in names] for tick in map(change, ticks) if tick]
        shown = [[time_ns, BEGIN_NS + time_ns] for time_ns in range(0, self.LAST_MS * 1_000_000, 40_000_000)]
        for path, lines in ((self.ticks, [names, *rows]), (self.frames, [["device_no_force_reason"], [limit], ["none"]]),
                            (self.screen, [["running_ns", "shown_ns"], *filter(None, map(screen, shown))])):
            path.write_text("".join(",".join(map(str, line)) + "\n" for line in lines))
        return delivery.judge(self.ticks, self.frames, self.screen, self.FRAMES, is_muted, others)

    def require(self, said, change=lambda tick: tick, **given):
        """That this is said of it, or nothing."""
        problem = self.judge(change, **given)[1]
        self.assertEqual((said in problem, bool(problem)), (True, bool(said)), problem)

    @staticmethod
    def within(begin_ms, end_ms, **values):
        """Doctors the ticks of this part of the clip's time; takes them out without `values`."""
        return lambda tick: (tick | values if values else None) if begin_ms <= tick["running_ns"] / 1e6 < end_ms else tick

    @staticmethod
    def moved(begin_s=0, end_s=9, **shape):
        """Ticks with another force, N, or torque, N m, by the clip's time, s, and what it was."""
        def doctored(tick):
            time_s = tick["running_ns"] / 1e9
            if not begin_s <= time_s < end_s:
                return tick
            names = {each: f"delivered_torque_{each[1]}_Nm" if each[0] == "t" else f"delivered_force_{each}_N" for each in shape}
            return tick | {names[each]: change(time_s, tick[names[each]]) for each, change in shape.items()}
        return doctored

    def scaled(self, factor):
        return self.moved(x=lambda _, own_N: factor * own_N)

    def test_counts_what_a_hand_cannot_tell_from_what_it_should_get(self):
        share, problem = self.judge()
        self.assertEqual((round(share, 6), problem), (1, ""))
        share, problem = self.judge(self.scaled(0.9))
        self.assertEqual((round(share, 6), problem), (0.9, ""))
        self.assertEqual(self.judge(is_muted=True), (0, ""), "none was to be felt")
        for change in (self.moved(x=lambda t, _: sway(max(0, t - 0.044))), self.moved(x=lambda t, _: sway(min(2, t + 0.044))),
                       self.moved(x=lambda t, own_N: math.cos(0.3) * own_N, y=lambda t, _: math.sin(0.3) * sway(t)),
                       self.moved(z=lambda *_: 0.035), self.moved(tz=lambda *_: 0.0008),
                       self.moved(y=lambda t, _: 0.03 * math.sin(100 * t)), self.within(700, 709)):
            self.require("", change)

    def test_does_not_count_what_a_hand_can_tell(self):
        for change in (self.scaled(0.85), self.scaled(1.2), self.scaled(-1),
                       self.moved(x=lambda t, _: sway(t - 0.06)), self.moved(x=lambda t, _: sway(t + 0.06)),
                       self.moved(x=lambda t, own_N: math.cos(0.4) * own_N, y=lambda t, _: math.sin(0.4) * sway(t)),
                       self.moved(z=lambda *_: 0.05), self.moved(ty=lambda *_: -0.001),
                       self.moved(x=lambda t, own_N: own_N + 0.025 * t),
                       *(self.moved(y=lambda t, _, hz=hz: 0.1 * math.sin(2 * math.pi * hz * t)) for hz in (0.5, 3, 12, 450)),
                       self.moved(1.2, 1.3, x=lambda _, own_N: -own_N), self.moved(1.2, 1.22, y=lambda *_: 1),
                       self.moved(1.2, 1.23, x=lambda *_: 0), self.moved(1.2, 1.201, x=lambda *_: float("nan")),
                       self.moved(x=lambda t, _: sway(t / 1.05)), self.moved(x=lambda t, _: sway(0.3 * (t // 0.3)))):
            self.require("as far from what it should be as is noticed", change)
        self.require("-96 % of the clip's force", self.scaled(-1))  # the cosine of 45 ms of a second, the best lag

    def test_a_fast_motion_is_not_right_at_any_time(self):
        """It passes in 40 ms through all that it has: what stands anywhere there is no lag."""
        with patch.object(Delivery, "FRAMES", film(lambda t: sway(t, 5))):
            for amount in 0, 0.2:
                self.require("as is noticed", self.moved(x=lambda *_: amount))
            self.require("", self.moved(x=lambda t, own_N: own_N))

    def test_a_torque_counts_as_a_force_does(self):
        with patch.object(Delivery, "FRAMES", film(sway, lambda t: 0.008 * math.sin(6 * t))):
            for factor, said in (1, ""), (0.9, ""), (0.8, "as is noticed"), (0, "as is noticed"), (-1, "as is noticed"):
                self.require(said, self.moved(tz=lambda _, own_Nm: factor * own_Nm))

    def test_where_nothing_is_to_be_felt_nothing_is(self):
        for change in (self.moved(x=lambda *_: 0.05), self.moved(1, 1.01, y=lambda *_: 0.5), self.moved(tx=lambda *_: 0.002),
                       self.moved(y=lambda t, _: 0.05 * math.sin(200 * t))):
            self.require("as is noticed", change, is_muted=True)

    def test_a_condition_too_weak_to_be_felt_counts(self):
        with patch.object(Delivery, "FRAMES", film(lambda t: 0.03)):
            self.assertEqual(self.judge(), (1, ""))

    def test_says_why_it_was_not_right(self):
        for said, change, given in [
                ("of the device or the playback: vibration", self.scaled(0), {"limit": "vibration"}),
                ("80 ms too late", self.moved(x=lambda t, _: sway(t - 0.08)), {}),
                ("80 ms too early", self.moved(x=lambda t, _: sway(t + 0.08)), {}),
                ("frames were late in 100 %", self.within(0, 2001, found="expired", delivered_force_x_N=0), {}),
                ("the device was idle in 20 % of the time",
                 lambda tick: tick | {"device": "idle" if tick["running_ns"] // 1_000_000 % 5 == 0 else "running"}, {}),
                ("the device was lost in 100 % of the time", lambda tick: tick | {"device": "lost"}, {}),
                ("the device did not run", lambda tick: tick | {"playing": 0}, {}),
                ("the device did not run", lambda tick: tick | {"acknowledged": 0}, {})]:
            self.require(said, change, **given)

    def paused(self, ms):
        """The clip stands still for so long, on the screen too, and no force of it is lost."""
        later_ns = lambda running_ns: ms * 1_000_000 * (running_ns >= self.STALL_MS * 1_000_000)
        return {"change": lambda tick: tick | {"monotonic_ns": tick["monotonic_ns"] + later_ns(tick["running_ns"])},
                "screen": lambda row: [row[0], row[1] + later_ns(row[0])]}

    def test_nothing_stands_still(self):
        for is_muted in False, True:
            self.require("", **self.paused(55), is_muted=is_muted)
            self.require("the picture stood still for 150 ms", **self.paused(110), is_muted=is_muted)
            for change in (self.within(700, 815), self.within(700, 815, playing=0), self.within(700, 815, acknowledged=0),
                           self.within(0, 115), self.within(1890, 2001)):
                self.require("the device stood still, or was elsewhere in the clip, for 11", change, is_muted=is_muted)

    def test_the_picture_counts_as_the_screen_showed_it(self):
        """Not as it was due; the force goes on."""
        def stops(begin_ms, ms):
            free_ns = BEGIN_NS + (begin_ms + ms) * 1_000_000
            return lambda row: [row[0], max(row[1], free_ns) if row[1] > BEGIN_NS + begin_ms * 1_000_000 else row[1]]

        late = lambda ms: lambda row: [row[0], row[1] + ms * 1_000_000]
        dropped = lambda part: lambda row: row if row[0] // 40_000_000 % part else [row[0], ""]
        steep = 960  # where the force changes by 2.6 N/s
        for screen, said in ((stops(steep, 75), ""), (stops(steep, 200), "the picture stood still for 200 ms"), (late(30), ""),
                             (late(90), "as is noticed"), (dropped(4), ""), (dropped(1), "the picture stood still"),
                             (lambda row: row if row[0] < 1_800_000_000 else None, "the picture stood still for 200 ms"),
                             (lambda row: row if not 600_000_000 < row[0] < 800_000_000 else None, "the picture stood still for 200")):
            self.require(said, screen=screen)
        self.assertIn("the picture stood for", self.judge(screen=late(90))[1])
        self.assertIn("the picture was ahead for", self.judge(screen=late(-90))[1])
        for screen in late(-60), late(60):
            self.require("as is noticed", screen=screen)
        self.require("", screen=late(-30))
        with patch.object(Delivery, "FRAMES", film(sway, frame_ms=120)):  # each stands for so long
            self.require("", screen=lambda row: row if row[0] % 120_000_000 == 0 else None)

    def test_the_clip_is_as_long_as_it_should_be_and_evenly_so(self):
        """By the clock, where nothing is to be felt, too; and its pictures are where its preview has them."""
        def stretched(factor, begin_ms=0):
            later_ns = lambda running_ns: int((factor - 1) * max(0, running_ns - begin_ms * 1_000_000))
            return {"change": lambda tick: tick | {"monotonic_ns": tick["monotonic_ns"] + later_ns(tick["running_ns"])},
                    "screen": lambda row: [row[0], row[1] + later_ns(row[0])]}

        drifting = lambda ms: {"screen": lambda row: [row[0], row[1] + row[0] * ms // 2000]}
        another_rate = lambda factor: {"screen": lambda row: [int(factor * row[0]), BEGIN_NS + int(factor * row[0])]}
        for is_muted in False, True:
            for given in stretched(1.04), stretched(0.96), drifting(-30):
                self.require("", **given, is_muted=is_muted)
            for given in (stretched(0.5), stretched(0.8), stretched(0.9), stretched(1.1), stretched(1.5), stretched(0.8, 1200),
                          drifting(-400), drifting(300), another_rate(1.3), another_rate(0.5)):
                self.assertTrue(self.judge(**given, is_muted=is_muted)[1])
            self.require("longer or shorter than it should be by 200 ms", **stretched(0.9), is_muted=is_muted)
            self.require("ms from where the preview has one", screen=lambda row: [row[0] + 15_000_000, row[1] + 15_000_000], is_muted=is_muted)

    def test_a_force_that_stands_at_the_end_of_a_clip_does_not_count(self):
        """After the motion of the last frame, too, where the force goes to rest."""
        trace = self.frames.with_name("preview")
        times = [40_000_000 * n for n in range(51)]
        trace.write_text(f"running_time_ns,{','.join(delivery.WRENCH)}\n" + "".join(
            f"{time_ns},{sway(time_ns / 1e9 - 0.02)},0,0,0,0,0\n" for time_ns in times))
        with patch.object(Delivery, "FRAMES", preview.read_trace(trace)), patch.object(Delivery, "LAST_MS", 2040):
            curve = delivery.between(self.FRAMES, np.arange(2041) * 1e6)[:, 0]
            for length_ms, said in (0, ""), (150, "as is noticed"), (30, ""):
                self.require(said, self.moved(x=lambda t, _: curve[min(round(1000 * t), 2040 - length_ms)]))

    def test_the_force_of_another_condition_does_not_count(self):
        """Also where no moment of it is told from its own: here by 10 % of its strength, evenly."""
        other_N = lambda wanted_N: math.copysign(0.577 * math.sqrt(abs(wanted_N)), wanted_N)
        others = [[[time_ns, other_N(force_N), *rest] for time_ns, force_N, *rest in self.FRAMES]]
        blend = lambda part: self.moved(x=lambda _, own_N: (1 - part) * own_N + part * other_N(own_N))
        self.require("", others=others)
        self.require("", self.scaled(0.9), others=others)
        for late_s in -0.04, 0.04:
            self.require("", self.moved(x=lambda t, _: sway(np.clip(t - late_s, 0, 2))), others=others)
        self.require("another condition", blend(0.2), others=others)
        self.require("another condition", blend(0.7), others=others)
        self.require("", others=[self.FRAMES])  # nobody tells them apart

    def test_a_vibration_does_not_count_though_the_force_is_strong(self):
        """Of 0.1 N, with 1 N that stands: the change of that would not be noticed."""
        with patch.object(Delivery, "FRAMES", film(lambda t: 1)):
            for hz in 12, 45, 220:
                for axis in "xy":
                    self.require("there was a vibration of 0.1", self.moved(
                        0.5, 1.5, **{axis: lambda t, own_N: own_N + 0.1 * math.sin(2 * math.pi * hz * t)}))
            self.require("", self.moved(y=lambda t, _: 0.03 * math.sin(100 * t)))


if __name__ == "__main__":
    unittest.main()
