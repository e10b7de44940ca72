# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack record of films that are damaged, turned, or do not begin at 0."""
import unittest

import track_case

BALL = "videotestsrc num-buffers=50 pattern=ball ! video/x-raw,width=320,height=240,framerate=25/1 ! "
# A picture stands still for a second and then moves to the right.
MOVING = ("ffmpeg -nostdin -v error -y -f lavfi -i \"color=gray:s=480x240:r=25,noise=alls=60:all_seed=1,gblur=2,"
          "trim=end_frame=1,loop=-1:1,setpts=N/25/TB,crop=320:240:'if(lt(n,25),100,100-4*(n-25))':0\" ")


def onset_ms(samples):
    """When force begins in a track."""
    return next(ms for ms, sample in enumerate(samples) if abs(sample[0]) > .01)


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
        self.expect_refused(self.cut("whole.mkv", size // 2), "it ends at ")
        self.expect_refused(self.cut("whole.mkv", 1000))  # before the first frame ends
        self.gst(BALL, "jpegenc ! qtmux faststart=true ! filesink location=flat.mov")
        self.expect_refused(self.cut("flat.mov", self.path("flat.mov").stat().st_size // 2), "it ends at ")
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

    def encode(self, arguments):
        self.run_in_folder(MOVING + arguments)

    @track_case.needs("ffmpeg")
    def test_a_film_with_b_frames_and_sound_is_felt_when_it_is_shown(self):
        """The same film without sound is the measure. GStreamer counts the times of a transport stream from its
        first clock reference, 780 ms before the first picture. 21.3 ms of AAC come before the time 0 of ffmpeg, and
        matroskademux, which counts milliseconds, moves its segment there after the first frame."""
        encoding = "-t 2 -c:v libx264 -bf 3 -c:a aac "
        self.encode(encoding + "silent.mp4")
        for name in ("sound.mkv", "sound.ts"):
            self.encode("-f lavfi -i sine=d=2:r=48000 " + encoding + name)
        onset = {}
        for name in ("silent.mp4", "sound.mkv", "sound.ts"):
            self.spidartrack("record", name, "--", "motion=mean")
            onset[name] = onset_ms(self.samples(name + ".haptic.flac"))
        self.assertGreater(onset["silent.mp4"], 900)
        self.assertAlmostEqual(onset["sound.mkv"], onset["silent.mp4"] + 21, delta=1)
        self.assertAlmostEqual(onset["sound.ts"], onset["silent.mp4"] + 780, delta=1)

    @track_case.needs("ffmpeg")
    def test_a_film_that_is_turned_when_it_is_shown_is_felt_as_it_is_shown(self):
        """A film of a telephone held upright: its picture is stored on its side, with a tag. ffmpeg turns the picture
        when it decodes the film, and videoflip in a pipeline, where the tag may stay."""
        self.encode("-t 2 -c:v libx264 stored.mp4")
        # Newer releases of ffmpeg have -display_rotation in place of rotate=90.
        self.run_in_folder(
            "ffmpeg -nostdin -v quiet -y -display_rotation 90 -i stored.mp4 -c copy turned.mp4 || "
            "ffmpeg -nostdin -v error -y -i stored.mp4 -c copy -metadata:s:v rotate=90 turned.mp4; "
            "ffmpeg -nostdin -v error -y -i turned.mp4 -c:v libx264 -metadata:s:v rotate=0 upright.mp4")
        for film in ("stored", "turned", "upright"):
            self.spidartrack("record", "--format", "wav", film + ".mp4", "--", "motion=mean", "alpha=0.01")
        self.gst("filesrc location=turned.mp4 ! decodebin ! videoconvert ! videoflip video-direction=auto ! spidarmotion "
                 "motion=mean alpha=0.01 device=none attach-meta=true ! spidarextract name=x x.wrench ! wavenc ! "
                 "filesink location=flipped.mp4.haptic.wav")
        felt = {film: self.samples(film + ".mp4.haptic.wav")[1800]
                for film in ("stored", "turned", "upright", "flipped")}
        force = felt["stored"][0]
        self.assertGreater(force, .01, "to the right")
        # A wrong turn differs by the whole force in at least one direction; a film that is coded again, and analysed
        # lying on its side, by about a tenth.
        tolerance = force / 5
        # Up or down: as ffmpeg shows the film.
        self.assertAlmostEqual(felt["upright"][0], 0, delta=tolerance)
        self.assertAlmostEqual(abs(felt["upright"][1]), force, delta=tolerance)
        for film in ("turned", "flipped"):
            for axis in (0, 1):
                self.assertAlmostEqual(felt[film][axis], felt["upright"][axis], delta=tolerance)


if __name__ == "__main__":
    unittest.main()
