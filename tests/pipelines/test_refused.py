# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The system refuses each thread, file, map, socket and process once (refuse.c, which REFUSE_LIBRARY names): nothing
aborts, a command either succeeds or says why it did not and leaves nothing behind, and the video of an element goes on."""
import os
import subprocess
import unittest

import track_case
from track_case import PROGRAM

FUNCTIONS = ("pthread_create", "open", "fopen", "mmap", "socket", "socketpair", "eventfd", "memfd_create", "pipe2",
             "dlopen", "fork", "posix_spawn")
MOST_CALLS = 60  # far more than any command makes


class Refused(track_case.TrackCase):
    def each_refused(self, command):
        """Runs the command with each of its calls refused; yields the process and what it has printed."""
        for function in FUNCTIONS:
            for at in range(1, MOST_CALLS):
                hit = self.folder.with_suffix(".hit")
                env = dict(os.environ, LD_PRELOAD=os.environ["REFUSE_LIBRARY"], REFUSE=function, REFUSE_AT=str(at),
                           REFUSE_HIT=str(hit))
                run = subprocess.run(command, cwd=self.folder, env=env, stdout=subprocess.PIPE,
                                     stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, timeout=60, check=False)
                if not hit.exists():
                    break
                hit.unlink()
                with self.subTest(function=function, at=at):
                    yield run.returncode, run.stdout.decode(errors="replace")

    def expect_done_or_said(self, command, results):
        whole = {}
        for name in results:
            self.path(name).unlink(missing_ok=True)
        self.spidartrack(*command)
        for name in results:
            whole[name] = self.path(name).read_bytes()
            self.path(name).unlink()
        before = self.files()
        for status, said in self.each_refused([PROGRAM, *command]):
            self.assertIn(status, (0, 1), said)
            made = self.files() - before
            self.assertLessEqual(made, set(results), said)
            for name in made:
                self.assertEqual(self.path(name).read_bytes(), whole[name])
                self.path(name).unlink()
            if status == 0:
                self.assertEqual(made, set(results), said)
            else:
                self.assertRegex(said, "(spidartrack|failed): ")

    def test_record(self):
        self.make_film("x.avi", 10)
        self.make_film("y.avi", 10)
        self.expect_done_or_said(["record", "-j2", "x.avi", "y.avi"], ["x.avi.haptic.flac", "y.avi.haptic.flac"])

    def test_convert(self):
        self.make_track()
        for target in ("b.flac", "b.hjif"):
            self.expect_done_or_said(["convert", "a.wav", target], [target])

    @track_case.needs("gnuplot")
    def test_plot(self):
        self.make_track()
        self.expect_done_or_said(["plot", "a.wav", "a.png"], ["a.png"])

    def test_the_video_of_an_element_goes_on(self):
        self.make_track("film.haptic.wav", 400)
        played = ["gst-launch-1.0", "-q", *"videotestsrc num-buffers=10 pattern=ball ! video/x-raw,width=64,height=48,"
                  "framerate=25/1 ! spidarmotion trace=t.csv haptic-trace=h.csv track=film.haptic.wav ! fakesink "
                  "name=last".split()]
        for status, said in self.each_refused(played):
            # A device that cannot be opened keeps a pipeline from starting.
            if "while opening the device" not in said and "post_exception" not in said:
                self.assertEqual(status, 0, said)
            self.assertIn(status, (0, 255), said)


if __name__ == "__main__":
    unittest.main()
