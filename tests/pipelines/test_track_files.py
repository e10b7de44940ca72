# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The files that spidartrack writes, whatever their names are and whatever a shell has closed."""
import os

import track_case
from track_case import PROGRAM


class Files(track_case.TrackCase):
    def test_what_is_printed_does_not_go_into_a_file(self):
        self.make_film()
        self.spidartrack("record", "film.avi")
        whole = self.path("film.avi.haptic.flac").read_bytes()
        for closed in (">&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                self.run_in_folder(f"{PROGRAM} record --force film.avi {closed}")
                self.assertEqual(self.path("film.avi.haptic.flac").read_bytes(), whole)
                self.run_in_folder(f"{PROGRAM} convert film.avi.haptic.flac a.funscript {closed}")
                self.assertEqual(self.path("a.funscript").read_bytes()[:1], b"{")

    def test_a_film_has_a_track_where_the_name_of_that_fits(self):
        self.make_film()
        for length in (230, 243):  # and 12 bytes for .haptic.flac are 255
            name = "あ" * ((length - 4) // 3) + "x" * ((length - 4) % 3) + ".avi"
            os.link(self.path("film.avi"), self.path(name))
            self.spidartrack("record", name)
            self.assertEqual(len(self.samples(name + ".haptic.flac")), 1000)
        self.path(name).rename(self.path("x" + name))
        self.assert_said("name too long", "record", "x" + name)

    def part_file(self):
        """The name of the file that a track is written into first."""
        self.path("out").mkdir()
        os.mkfifo(self.path("film.avi"))  # a film that never ends
        waiting = self.run_in_folder(
            f"{PROGRAM} record film.avi --folder out & "
            "until [ -n \"$(ls -A out)\" ]; do sleep .02; done; ls -A out; kill $!; wait $!; true")
        self.path("film.avi").unlink()
        names = {line for line in waiting.split() if line.startswith(".part-")}
        self.assertEqual(len(names), 1, waiting)
        return self.path("out") / names.pop()

    def test_nothing_that_lies_at_the_name_of_a_part_file_is_written_into(self):
        part = self.part_file()
        self.assertFalse(part.exists(), "it is removed by the signal")
        self.make_film()
        mine = self.path("mine")
        mine.write_text("mine")
        part.symlink_to(mine)
        self.assert_said("remove it", "record", "film.avi", "--folder", "out")
        self.assertEqual(mine.read_text(), "mine")
        part.unlink()
        os.link(mine, part)
        self.spidartrack("record", "film.avi", "--folder", "out")
        self.assertEqual(mine.read_text(), "mine")
        # What a killed process left.
        part.write_text("x" * 1000000)
        self.spidartrack("record", "--force", "film.avi", "--folder", "out")
        self.assertEqual(len(self.samples("out/film.avi.haptic.flac")), 1000)
        self.assertEqual(os.listdir(part.parent), ["film.avi.haptic.flac"])


track_case.main()
