# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A track is accepted for the film that it was recorded from, in any container, and for no other; and what happens to
films and folders while a film is recorded is an error in one sentence, and leaves no file that is taken for whole."""

import csv
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

import track_case

TRACK = ".haptic.flac"


@track_case.needs("ffmpeg")
class OwnFilm(track_case.TrackCase):
    def make(self, name, sound_s=2, picture="testsrc2", options=""):
        """Two seconds of H.264 with B-frames, and so many seconds of AAC."""
        self.run_in_folder(
            f"ffmpeg -nostdin -v error -y -f lavfi -i {picture}=r=25:s=160x120 -f lavfi -i sine=r=48000:d={sound_s} -map 0:v "
            f"-map 1:a -frames:v 50 -c:v libx264 -preset ultrafast -bf 2 -c:a aac {options} {name}")

    def copy(self, film, name, options=""):
        self.run_in_folder(f"ffmpeg -nostdin -v error -y -i {film} -c copy {options} {name}")

    def belongs(self, recorded, film):
        """Whether the track of one film is that of another one; when not, why not."""
        if recorded != film:
            shutil.copy(self.path(recorded + TRACK), self.path(film + TRACK))
        said = self.spidartrack("info", film)
        self.assertEqual(json.loads(self.spidartrack("info", "--json", film))["belongs"], "of another film" not in said)
        return "" if "of another film" not in said else said

    def test_it_is_recognised_in_any_container(self):
        self.make("film.mp4")
        self.spidartrack("record", "film.mp4")
        copies = ("copy.mkv", "copy.mov", "copy.flv", "copy.ts", "silent.mp4")
        for name in copies:
            with self.subTest(name):
                self.copy("film.mp4", name, "-an" if name.startswith("silent") else "")
                self.assertEqual(self.belongs("film.mp4", name), "")
                self.spidartrack("record", "--force", name)
                self.assertEqual(self.belongs(name, name), "")
        for name in copies:
            self.assertEqual(self.belongs(name, "film.mp4"), "", name)

    def test_any_other_is_not(self):
        self.make("film.mp4")
        self.spidartrack("record", "film.mp4")
        self.make("mandelbrot.mp4", picture="mandelbrot")
        self.make("anew.mp4", options="-crf 30")
        for name in ("mandelbrot.mp4", "anew.mp4"):
            self.assertIn("recorded from other pictures", self.belongs("film.mp4", name))
        self.copy("film.mp4", "cut.mkv", "-t 1")
        self.assertIn("the film 1.", self.belongs("film.mp4", "cut.mkv"))

    def forces(self, film, track):
        """What is felt of a track at each frame, with the running time in ms."""
        self.gst(f"filesrc location={film} ! decodebin ! videoconvert ! spidarmotion device=none trace=t.csv track={track} "
                 "! fakesink")
        with open(self.path("t.csv"), newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertFalse([row for row in rows if row["features"] != "0"], "it is not analysed")
        return [float(row["force_x_N"]) for row in rows]

    def test_a_track_moves_with_the_pictures_into_another_container(self):
        """In a transport stream the pictures begin later: the bytes are the same, the times are not."""
        self.make("film.mp4")
        self.copy("film.mp4", "copy.ts")
        for name in ("film.mp4", "copy.ts"):
            self.spidartrack("record", name)
            self.path(name + TRACK).rename(self.path(f"of-{name}.flac"))
        # A track that was not moved would be some pictures off, 100 ms and more.
        for film in ("film.mp4", "copy.ts"):
            from_other, own = (self.forces(film, f"of-{name}.flac") for name in ("film.mp4", "copy.ts"))
            self.assertGreater(max(map(abs, own)), .1)
            # Times of MPEG-TS are multiples of 1/90 ms, and samples are a millisecond apart.
            for one, other in zip(from_other, own):
                self.assertAlmostEqual(one, other, delta=.05 * max(map(abs, own)))

    def test_its_sound_may_be_longer(self):
        for name in ("film.mp4", "film.mkv", "film.flv"):
            for sound_s in (2.03, 2.2, 7):
                with self.subTest(name, sound_s=sound_s):
                    self.make(name, sound_s)
                    self.spidartrack("record", "--force", name)
                    self.assertEqual(self.belongs(name, name), "")
                    # Without notes, as made by hand.
                    samples = self.samples(name + TRACK)
                    self.path(name + TRACK).unlink()
                    track_case.write_wav(self.path(name + ".haptic.wav"), samples)
                    self.assertEqual(self.belongs(name, name), "")
                    self.path(name + ".haptic.wav").unlink()


class Faults(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.make_film("film.avi", 4000)
        self.path("out").mkdir()

    def record(self, fault):
        """Records the film, stops when some of it is written, lets `fault` happen, and goes on. The error."""
        with subprocess.Popen([track_case.PROGRAM, "record", "film.avi", "--folder", "out"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
            while running.poll() is None and not any(file.stat().st_size for file in self.path("out").iterdir()):
                time.sleep(.001)
            running.send_signal(signal.SIGSTOP)
            fault()
            running.send_signal(signal.SIGCONT)
            said = running.communicate()[0]
        self.assertEqual(running.returncode, 1, said)
        return said

    def test_a_film_that_changes_is_not_whole(self):
        self.make_film("other.avi", 25)
        film = self.path("film.avi")

        def grow():
            with open(film, "ab") as file:
                file.write(b"more")

        for fault, said in ((grow, "it was changed while it was read: wait until it is complete"),
                            (lambda: self.path("other.avi").rename(film), "it was changed while it was read"),
                            (film.unlink, "it was removed while it was read, or its share has gone")):
            self.assertIn(said, self.record(fault))
            self.assertEqual(os.listdir(self.path("out")), [])
            self.make_film("film.avi", 4000)

    def test_a_folder_that_goes_away_is_named(self):
        out = self.path("out")
        self.assertIn("there is no folder out", self.record(lambda: shutil.rmtree(out)))
        out.mkdir()
        # Where a share was mounted, there is an empty folder.
        self.assertIn("cannot be written: No such file or directory",
                      self.record(lambda: (shutil.rmtree(out), out.mkdir())))
        self.assertEqual(os.listdir(out), [])


if __name__ == "__main__":
    unittest.main()
