# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack record of films that are damaged, or have no motion."""
import os
import re
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

    def test_a_film_that_has_just_begun_to_be_written_is_damaged(self):
        heads = (b"RIFF\xff\xff\0\0AVI LIST", b"RIFF\xff\xff\0\0WAVEfmt ", b"OggS\0\2\0\0", b"\0\0\0\x18ftypmp42",
                 b"\x1aE\xdf\xa3\x01\0\0\0", b"fLaC\0\0\0\"")
        count = 0
        for head in heads:
            for size in (4, 7, 11):
                self.path(f"{count}.avi").write_bytes(head[:size])
                count += 1
        said = self.spidartrack("record", *(f"{i}.avi" for i in range(count)), status=1)
        self.assertIn(f"0 recorded, 0 there, {count} failed", said)
        for why in re.findall(r"\.avi: failed: (.*)", said):
            self.assertNotRegex(why, "basic_string|std::|vector")  # of the C++ library

    def test_what_is_appended_to_a_film_is_no_part_of_it(self):
        """By cameras, taggers and editors."""
        whole = {"a.mov": "jpegenc ! qtmux", "b.mov": "jpegenc ! qtmux faststart=true",
                 "c.mov": "jpegenc ! qtmux fragment-duration=200", "d.3gp": "avenc_mpeg4 ! mp4mux",
                 "e.avi": "jpegenc ! avimux", "f.mkv": "jpegenc ! matroskamux", "g.ogg": "theoraenc ! oggmux"}
        for name, encoding in whole.items():
            self.gst(BALL, encoding, "! filesink location=" + name)
            content = self.path(name).read_bytes()
            for appended in (b"\n", b"TAG" + bytes(125), bytes(range(256)) * 3):
                with self.subTest(name=name, appended=appended[:8]):
                    self.path(name).write_bytes(content + appended)
                    if name[0] == "c" and len(appended) < 8:
                        continue  # it may as well be the beginning of another fragment
                    self.spidartrack("record", "--force", name)
        # A box of the film that is cut off is none of these.
        for box in (b"mdat", b"moof", b"moov"):
            self.gst(BALL, "jpegenc ! qtmux ! filesink location=h.mov")
            self.path("h.mov").write_bytes(self.path("h.mov").read_bytes() + b"\0\1\0\0" + box + bytes(100))
            self.expect_refused("h.mov", "its end is missing")

    def test_frames_that_are_not_measured_are_named_by_their_cause(self):
        for name, line, cause in (
                ("small.mkv", "videotestsrc num-buffers=25 ! video/x-raw,width=12,height=12,framerate=25/1 ! jpegenc ! "
                 "matroskamux", "Frames with a side below 16"),
                ("no_times.mjpeg", BALL + "jpegenc", "Frames without a timestamp")):
            self.gst(line, "! filesink location=" + name)
            said = self.spidartrack("record", "--folder", "out", name, status=1)
            self.assertIn("failed: its frames are not measured: " + cause, said)
            self.assertNotIn("attach-meta", said)

    def test_a_plug_in_that_is_missing_is_named(self):
        self.gst(BALL, "theoraenc ! matroskamux ! filesink location=film.mkv")
        self.make_track("a.wav")
        self.spidartrack("convert", "a.wav", "a.flac")
        for missing, command, said in (
                ("theoradec:0,avdec_theora:0", ["record", "film.mkv"], "Theora decoder"),
                ("matroskademux:0,avdemux_matroska:0", ["record", "film.mkv"], "Matroska demuxer"),
                ("flacdec:0,avdec_flac:0", ["info", "a.flac"], "(FLAC) decoder"),
                ("flacparse:0,avdemux_flac:0", ["info", "a.flac"], "cannot take audio/x-flac apart")):
            self.assert_said(said, *command, env=dict(os.environ, GST_PLUGIN_FEATURE_RANK=missing))

    @track_case.needs("ffmpeg")
    def test_a_cover_is_not_the_film(self):
        self.gst("videotestsrc num-buffers=1 ! video/x-raw,width=600,height=600 ! jpegenc ! filesink location=cover.jpg")
        self.gst(BALL, "theoraenc ! matroskamux ! filesink location=film.mkv")
        for disposition in ("0", "attached_pic"):
            self.run_in_folder("ffmpeg -nostdin -v error -y -i cover.jpg -i film.mkv -map 0 -map 1 -c copy "
                               f"-disposition:v:0 {disposition} both.mkv")
            self.spidartrack("record", "--force", "both.mkv")
            self.assertEqual(len(self.samples("both.mkv.haptic.flac")), 2000)
            # The picture that the track knows its film by is one of the film.
            self.path("both.mkv.haptic.flac").rename(self.path("film.mkv.haptic.flac"))
            self.assertIn("is there", self.spidartrack("record", "film.mkv"))

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
