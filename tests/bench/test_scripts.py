#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The scripts that measure with films of others, on films and numbers that are made here.

    test_scripts.py
"""

import csv
import json
import math
import random
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parent

import shares  # noqa: E402

try:
    import numpy as np
except ImportError:
    sys.exit(77)

sys.path.append(str(FOLDER.parent / "docs"))
import check_figures  # noqa: E402
import gyroscope  # noqa: E402
import same_films  # noqa: E402
from real_films import Frame, Tally, read_other  # noqa: E402


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


class SameFilms(unittest.TestCase):
    def test_a_force_is_compared_with_the_mirrored_one(self):
        film = [(1, 0), (1, 0), (1, 0), (1, .5), (0, 0), (0, 0)]
        changed = [(-1, .1), (1, 0), (0, 0), (-1, 1.5), (0, 0), (0, 1)]
        self.assertEqual(same_films.compare(film, changed, -1), [4, 2, 1, 1, 2, 1])
        self.assertEqual(same_films.compare(film, film, 1), [4, 4, 0, 0, 2, 0])


class Benchmark(unittest.TestCase):
    """tests/bench/real_films/, which others enter."""

    @staticmethod
    def rows(name):
        with open(FOLDER / "real_films" / name, encoding="utf-8") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    def test_its_splits_are_drawn_as_it_says(self):
        clips = self.rows("clips.tsv")
        of = {kind: sorted(row["clip"] for row in clips if row["moves"] == kind) for kind in ("object", "camera")}
        self.assertEqual([len(names) for names in of.values()], [35, 15])
        source = random.Random(1)
        third = source.sample(of["object"], 11) + source.sample(of["camera"], 5)
        self.assertEqual({row["clip"] for row in clips if row["split"] == "third"}, set(third))
        for row in clips:
            self.assertTrue(row["data set"] and row["licence"] and row["redistribute"].split(",")[0] in ("yes", "no"), row)
            self.assertRegex(row["frames"], r"^\d+(-\d+)?$")
            self.assertRegex(row["sha256"], r"^([0-9a-f]{16}|-)$")
            self.assertTrue(row["address"].startswith("http"), row)
        self.assertEqual(sorted(row["film"] for row in clips), [f"c{n:02d}" for n in range(1, 51)])

    def test_each_method_has_all_its_figures(self):
        for row in self.rows("methods.tsv"):
            self.assertIn(row["films"], ("all", "third", "rest"))
            for name in "right %", "right % at 18.4°", "wrong %", "false %":
                if row[name] != "-":
                    value, low, high = map(float, re.fullmatch(r"([\d.]+) \((\d+)–(\d+)\)", row[name]).groups())
                    self.assertTrue(low - 0.5 <= value <= high + 0.5, row)
            self.assertRegex(row["mean of films, below half"], r"^-$|^[\d.]+, \d+ of \d+$")
            self.assertTrue(row["method"] and row["version"] and row["where"], row)


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


def item(key, kind, size, data, count=None):
    padded = data + b"\0" * (-len(data) % 4)
    return struct.pack(">4scBH", key, kind, size, len(data) // size if count is None else count) + padded


class Gyroscope(unittest.TestCase):
    def test_reads_the_samples_of_a_gopro(self):
        samples = [(10, -20, 30), (40, 50, -60), (7, 8, 9)]
        stream = (item(b"STNM", b"c", 1, b"Gyroscope (z,x,y)") + item(b"SCAL", b"s", 2, struct.pack(">h", 10)) +
                  item(b"GYRO", b"s", 6, b"".join(struct.pack(">3h", *row) for row in samples)))
        other = item(b"SCAL", b"s", 2, struct.pack(">h", 5)) + item(b"ACCL", b"s", 6, struct.pack(">3h", 1, 2, 3))
        device = item(b"STRM", b"\0", 1, other) + item(b"STRM", b"\0", 1, stream)
        self.assertEqual(gyroscope.gyro_samples(item(b"DEVC", b"\0", 1, device)),
                         [[value / 10 for value in row] for row in samples])
        self.assertEqual(gyroscope.gyro_samples(item(b"DEVC", b"\0", 1, item(b"STRM", b"\0", 1, other))), [])

    def made(self, lag_s=0.023, focal_px=500.0, noise_px_s=0.0, frames=240):
        """Times of frames; times and rates of a gyroscope that is built in with other axes; rates of the camera."""
        random = np.random.default_rng(3)
        gyro_s = np.arange(-0.5, frames / 30 + 0.5, 1 / 400)
        phases = random.uniform(0, 7, (3, 6))
        swing = lambda t: np.stack([sum(np.sin(2 * np.pi * f * t + p) * 0.3 / f for f, p in zip((0.3, 0.7, 1.1, 1.9, 2.7, 3.1),
                                                                                               row)) for row in phases], 1)
        times_s = np.arange(frames) / 30
        true = gyroscope.between(times_s, gyro_s, swing(gyro_s - lag_s), lag_s)  # yaw, pitch, roll
        gyro = np.stack([-swing(gyro_s - lag_s)[:, 2], swing(gyro_s - lag_s)[:, 0], swing(gyro_s - lag_s)[:, 1]], 1)
        moved = true * [focal_px, focal_px, 1] + random.normal(0, 1, true.shape) * noise_px_s * np.array([1, 1, 0.002])
        return times_s, gyro_s, gyro, np.nan_to_num(moved)

    def test_finds_lag_axes_and_focal_length(self):
        times_s, gyro_s, gyro, moved = self.made()
        known = np.arange(len(times_s)) >= 2
        fit = gyroscope.Fit(times_s, gyro_s, gyro, [moved, moved], known)
        self.assertEqual((list(fit.axes), list(fit.signs)), ([1, 2, 0], [1, 1, -1]))
        self.assertAlmostEqual(fit.lag_s, 0.023, delta=gyroscope.LAG_STEP_S)
        # A lag that is wrong by half a step of 1 ms, at 3 Hz at most: (2π · 3 · 0.0005)² / 2 of the slope.
        self.assertAlmostEqual(fit.focal_px, 500, delta=500 * 1e-3)

    def test_says_how_much_is_explained(self):
        times_s, gyro_s, gyro, moved = self.made(noise_px_s=20)
        table = gyroscope.report("film", times_s, gyro_s, gyro, {"one": moved, "weak": 0.8 * moved})
        rows = {tuple(cell.strip() for cell in line.split("|")[1:3]): [float(cell.split()[0]) for cell in line.split("|")[3:7]]
                for line in table.splitlines() if line.startswith(("| yaw", "| pitch", "| roll"))}
        for axis in "yaw", "pitch":
            (r, slope, error, turned), weak = rows[axis, "one"], rows[axis, "weak"]
            # Noise of 20 px/s beside 500 px · the rate: r² = s² / (s² + (20/500)²).
            noise = math.degrees(20 / 500)
            self.assertAlmostEqual(r, turned / math.hypot(turned, noise), delta=0.02)
            self.assertAlmostEqual(weak[1] / slope, 0.8, delta=0.002)  # three decimals are printed
            # f comes from both: (1 + 0.8² ) is not its square, but the mean of 1 and 0.8 is its share.
            self.assertAlmostEqual(slope, 1 / 0.9, delta=0.05)

    def test_without_a_folder_it_is_skipped(self):
        done = subprocess.run([sys.executable, FOLDER / "gyroscope.py"], capture_output=True, text=True, check=True)
        self.assertTrue(done.stdout.startswith("skipped: no folder"), done)


class Figures(unittest.TestCase):
    PAGE = "# Speed\n\nIt takes 3.5 ms.\n\n| size | time, ms |\n|---|---|\n| 640 | 0.25 (0.1–0.4) |\n| 1280 | −1.5 |\n"

    def wrong(self, rows, results=None):
        keys = check_figures.COLUMNS
        return list(check_figures.check({"a.md": self.PAGE}, [dict(zip(keys, row)) for row in rows], FOLDER.parents[1], results))

    def test_every_figure_of_a_page_has_a_command(self):
        bench = "build/tests/bench/spidar-bench "
        text, table = (["a.md", "Speed", part, bench + "cost", "cost", "0.1", ""] for part in ("text", "table"))
        self.assertEqual(self.wrong([text, table]), [])
        for rows, said in (([text], "the table below \"Speed\" has figures"), ([table], "the text below \"Speed\" has figures"),
                           ([text, table, ["a.md", "Pace", *text[2:]]], "there is no text below \"Pace\""),
                           ([text, [*table[:3], "-", *table[4:6], "measured once"]], "its note does not begin with constant"),
                           ([text, [*table[:3], bench + "speed", *table[4:]]], "there is no \"build/tests/bench/spidar-bench speed\"")):
            found = self.wrong(rows)
            self.assertEqual((len(found), said in found[0]), (1, True), found)

    def test_a_table_is_compared_with_what_the_command_printed(self):
        row = ["a.md", "Speed", "table", "-", "cost", "0.1", "constant"]
        rows = [row, ["a.md", "Speed", "text", "-", "-", "-", "constant"]]
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("is missing", self.wrong(rows, folder)[0])
            Path(folder, "cost.txt").write_text("0.27 0.1 0.4 -1.4", encoding="ascii")
            self.assertEqual(self.wrong(rows, folder), [])
            Path(folder, "cost.txt").write_text("0.29 0.1 0.4 -1.4", encoding="ascii")
            found = self.wrong(rows, folder)
            self.assertEqual((len(found), "a.md: 0.25 below" in found[0]), (1, True), found)

    def test_of_a_text_those_figures_that_its_row_names(self):
        rows = [["a.md", "*", "*", "-", "-", "-", "constant"], ["a.md", "Speed", "text", "-", "cost", "0.1: 3.5", "derived from it"]]
        with tempfile.TemporaryDirectory() as folder:
            for printed, wrong in ("3.6", 0), ("3.5e-3", 1), ("4", 1):
                Path(folder, "cost.txt").write_text(printed, encoding="ascii")
                self.assertEqual(len(self.wrong(rows, folder)), wrong, printed)
        rows[1][5] = "0.1: 3.6"
        self.assertIn("3.6 is not below", self.wrong(rows)[0])


if __name__ == "__main__":
    unittest.main()
