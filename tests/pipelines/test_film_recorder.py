# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack record of films that are damaged, or have no motion."""
import unittest

import track_case

BALL = "videotestsrc num-buffers=50 pattern=ball ! video/x-raw,width=320,height=240,framerate=25/1 ! "


class FilmRecorder(track_case.TrackCase):
    def setUp(self):
        super().setUp()
        self.path("out").mkdir()

    def expect_refused(self, name, cause=""):
        self.assert_said("failed: " + cause, "record", "--folder", "out", name)
        self.assertEqual(list(self.path("out").iterdir()), [], "no file is left behind")

    def cut(self, name, size):
        self.path("cut." + name).write_bytes(self.path(name).read_bytes()[:size])
        return "cut." + name

    def test_where_a_file_is_cut_off_does_not_matter(self):
        for name, encoding in (("whole.avi", "jpegenc ! avimux"), ("whole.ogg", "theoraenc ! oggmux"),
                               ("whole.mkv", "jpegenc ! matroskamux"),
                               ("whole.mov", "jpegenc ! qtmux fragment-duration=200")):
            with self.subTest(name):
                self.gst(BALL, encoding, "! filesink location=" + name)
                self.spidartrack("record", name)
                size = self.path(name).stat().st_size
                # In the last page, chunk, segment or box as well as in the middle.
                for length in (size - 1, size // 2):
                    self.expect_refused(self.cut(name, length))
        size = self.path("whole.mkv").stat().st_size
        self.expect_refused(self.cut("whole.mkv", size // 2), "its end is missing")
        self.expect_refused(self.cut("whole.mkv", 1000))  # before the first frame ends
        self.gst(BALL, "jpegenc ! qtmux faststart=true ! filesink location=flat.mov")
        self.expect_refused(self.cut("flat.mov", self.path("flat.mov").stat().st_size // 2), "its end is missing")
        # Of more than 1 GB, with the second chunk cut off.
        self.path("chunks.avi").write_bytes(self.path("whole.avi").read_bytes() + b"RIFF\0\1\0\0AVIX")
        self.expect_refused("chunks.avi", "its end is missing")
        # Only the header, of a film with sound.
        self.path("header.flv").write_bytes(b"FLV\1\5\0\0\0\t\0\0\0\0")
        self.expect_refused("header.flv", "it cannot be read to its end")

    def test_sound_may_go_on_after_the_pictures_of_an_ogg(self):
        self.gst("oggmux name=mux ! filesink location=long.ogg", BALL, "theoraenc ! mux.",
                 "audiotestsrc num-buffers=300 samplesperbuffer=1024 ! audio/x-raw,rate=48000 ! audioconvert ! "
                 "vorbisenc ! mux.")
        self.spidartrack("record", "long.ogg")

    def test_what_has_no_motion_says_so(self):
        self.gst("audiotestsrc num-buffers=20 ! matroskamux ! filesink location=sound.mkv")
        self.expect_refused("sound.mkv", "there is no video in it")
        # qtdemux takes such pictures for a preview.
        self.gst("qtmux name=mux ! filesink location=short.mp4 videotestsrc num-buffers=25 ! "
                 "video/x-raw,framerate=25/1 ! jpegenc ! mux. audiotestsrc num-buffers=300 samplesperbuffer=1000 ! "
                 "audio/x-raw,rate=48000 ! mux.")
        self.expect_refused("short.mp4", "there is no video in it (GStreamer leaves out what is shorter")
        self.gst("videotestsrc num-buffers=1 ! pngenc ! filesink location=picture.png")
        self.expect_refused("picture.png", "it is a single picture")

    def test_time_stamps_that_jump_by_days_are_an_error(self):
        # From the eleventh frame on a million seconds later.
        self.gst("concat name=c ! matroskamux ! filesink location=jump.mkv "
                 "videotestsrc num-buffers=10 pattern=ball ! jpegenc ! c. "
                 "videotestsrc num-buffers=10 pattern=ball timestamp-offset=1000000000000000 ! jpegenc ! c.")
        self.expect_refused("jump.mkv", "The time stamps of the video jump from 0.3")


if __name__ == "__main__":
    unittest.main()
