#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The scripts that measure with films of others, on films and numbers that are made here.

    test_scripts.py
"""

import re
import tempfile
import unittest
from pathlib import Path

import shares
from real_films import Frame, Tally, read_other


class OtherMethod(unittest.TestCase):
    def test_a_method_is_scored_by_what_it_has_written(self):
        frames = [Frame((0, 0), .04, 480) for _ in range(6)]
        truth = {n: (4.0, 0.0) for n in range(1, 6)}
        with tempfile.TemporaryDirectory() as name:
            file, film = Path(name) / "a.csv", Path("films/a.mp4")
            with self.assertRaisesRegex(SystemExit, "a.csv is missing"):
                read_other(Path(name), film, frames)
            file.write_text("2,4,0\n3,-4,0\n4,3,0.5\n", encoding="ascii")
            tally = Tally()
            verdicts = tally.add(read_other(Path(name), film, frames), truth)
            self.assertEqual(verdicts, [(2, "right"), (3, "wrong"), (4, "right"), (5, "none")])
            self.assertTrue(tally.row("mine").startswith("| mine | 50.0 "))
            for wrong, said in ("6,1,1\n", "frames are 0 to 5"), ("1,1\n", "line 1: is to be frame,x,y"):
                file.write_text(wrong, encoding="ascii")
                with self.assertRaisesRegex(SystemExit, said):
                    read_other(Path(name), film, frames)


class Shares(unittest.TestCase):
    def test_the_interval_is_over_films_and_not_over_frames(self):
        # Two films of a thousand frames: half of the resamples draw one of them twice.
        self.assertEqual(shares.interval([(1000, 1000), (0, 1000)]), (0, 1))
        self.assertEqual(shares.interval([(3, 10)] * 8), (0.3, 0.3))
        # Clopper and Pearson of 0 and of 10 of 10: 1 − 0.025^(1/10)
        self.assertEqual(shares.share([(0, 30)] * 10), "0.0 (0 to 31)")
        self.assertEqual(shares.share([(30, 30)] * 10), "100.0 (69 to 100)")
        self.assertIsNone(shares.interval([(3, 10)]))
        self.assertEqual(shares.share([(3, 10), (0, 0)]), "30.0")
        self.assertEqual(shares.share([]), "-")

    def test_the_interval_has_the_width_of_the_mean_of_films(self):
        # 100 films, of each all or nothing with a chance of a half: ±1.96 · 0.5 / √100, and each bound is a quantile of
        # 4000 resamples, whose standard error is √(0.025 · 0.975 / 4000) / density = 0.002, of steps of 0.01.
        low, high = shares.interval([(n % 2, 1) for n in range(100)])
        for bound, true in (low, 0.402), (high, 0.598):
            self.assertAlmostEqual(bound, true, delta=4 * 0.002 + 0.01)

    def test_a_film_counts_with_its_frames(self):
        self.assertTrue(shares.share([(90, 90), (0, 10)]).startswith("90.0 ("))

    def test_the_mean_of_films_counts_each_film_once(self):
        self.assertEqual(shares.mean_of_films([(90, 90), (0, 10), (2, 10), (0, 0)]), "40.0, 2 of 3")
        self.assertEqual(shares.mean_of_films([]), "-")

    def test_the_curve_counts_what_is_within_an_angle_and_a_factor(self):
        films = [[(7, 1), (25, 1.9), (40, 1), None], [(7, 0.45), (3, 1.05), (7, 1), (7, 1)]]
        self.assertTrue(shares.within(films, 10, 2).startswith("50.0"))  # 4 of 8
        self.assertTrue(shares.within(films, 30, 2).startswith("62.5"))
        self.assertTrue(shares.within(films, 30, 3).startswith("75.0"))
        self.assertTrue(shares.within(films, 60, 1.1).startswith("62.5"))

    def test_methods_are_compared_by_films(self):
        some, none = [(9, 10)] * 12, [(0, 10)] * 12
        mean, p = re.fullmatch(r"([+-][\d.]+), p = ([\d.]+)", shares.paired(some, none)).groups()
        # All signs alike: 2 of 2^12, and of 4000 draws at least one counts.
        self.assertEqual((float(mean), float(p) < 0.004), (90, True))
        self.assertEqual(shares.paired(some, some), "+0.0, p = 1.0000")
        self.assertEqual(shares.paired(some, [(0, 0)] * 12), "-")

    def test_who_always_or_never_finds_a_motion_has_no_right_less_false(self):
        for motion, right, said in ((0, 0), "0.0", "0.0"), ((2, 0), "100.0", "0.0"), ((0, 2), "0.0", "-100.0"):
            tally = Tally()
            for truth in {n: (2, 0) for n in range(6)}, None:
                tally.add([Frame(motion, 1 / 24, 480)] * 6, truth)
            cells = [cell.strip() for cell in tally.trade_row("x").split("|")]
            self.assertEqual((cells[2].split(",")[0], cells[8].split()[0]), (right, said))
            self.assertEqual(cells[7], "0.0, 0.0", "of a frame 480 lines high, 48 px/s are not 32 times 2.1")

    def test_a_tally_keeps_each_film(self):
        tally = Tally()
        right, across = (Frame(motion, 1 / 24, 480, [motion]) for motion in ((4, 0), (0, 4)))
        for frame in right, across:
            tally.add([frame] * 6, {n: (4, 0) for n in range(6)})
        tally.add([right] * 6, None)
        cells = [cell.strip() for cell in tally.row("x").split("|")]
        self.assertEqual(cells[2:7], ["50.0 (0 to 100)", "50.0, 1 of 2", "100.0 (16 to 100)", "50.0 (0 to 100)",
                                      "100.0 (16 to 100)"])
        self.assertEqual(cells[7], "100.0", "of one film without an object")
        self.assertEqual([round(frame[0]) for film in tally.apart for frame in film], [0] * 4 + [90] * 4)


if __name__ == "__main__":
    unittest.main()
