# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""spidartrack show: what is in the film that it makes, by ffmpeg."""
import array
import json
import os
import pathlib
import re
import subprocess
import unittest

import track_case

WIDTH, HEIGHT, RATE_HZ, SECONDS = 640, 480, 25, 2
SOUND_HZ = 44100


ENCODERS = ("x264enc", "openh264enc")  # of which one is needed


def orange(rows):
    """So many pixels are, as outline and curve."""
    return sum(row[i] > 180 and row[i + 2] < 120 for row in rows for i in range(0, 3 * WIDTH, 3))


# The curve has 3 px in 480 lines: two are whole. It is as long as the film, of five seconds over the whole width.
CURVE_PX = .8 * 2 * WIDTH * SECONDS / 5
LOWER, UPPER = slice(HEIGHT * 85 // 100, None), slice(0, HEIGHT * 15 // 100)


@unittest.skipIf(all(subprocess.run(["gst-inspect-1.0", "--exists", element], check=False).returncode
                     for element in ENCODERS), f"needs one of {', '.join(ENCODERS)}")
@track_case.needs("ffmpeg", "ffprobe")
class ShownFilm(track_case.TrackCase):
    def make_sounding(self, name, sound="", muxer="avimux", width=WIDTH, height=HEIGHT):
        """A film of a ball, and of a tick each second."""
        self.gst(f"videotestsrc num-buffers={RATE_HZ * SECONDS} pattern=ball",
                 f"! video/x-raw,width={width},height={height},framerate={RATE_HZ}/1 ! jpegenc ! mux.",
                 f"audiotestsrc num-buffers={SECONDS * RATE_HZ} samplesperbuffer={SOUND_HZ // RATE_HZ} wave=ticks",
                 f"! audio/x-raw,rate={SOUND_HZ},channels=2 {sound} ! mux.",
                 f"{muxer} name=mux ! filesink location={name}")

    def streams(self, name):
        """Of each kind, what ffprobe says."""
        said = self.run_in_folder(["ffprobe", "-v", "error", "-count_packets", "-show_streams", "-of", "json", name])
        return {stream["codec_type"]: stream for stream in json.loads(said)["streams"]}

    def read(self, *options):
        return subprocess.run(["ffmpeg", "-nostdin", "-v", "error", *options, "-"], cwd=self.folder, check=True,
                              stdout=subprocess.PIPE).stdout

    def pictures(self, name, width=WIDTH, height=HEIGHT):
        """Of each frame its rows, of triples of red, green and blue."""
        pixels = self.read("-i", name, "-f", "rawvideo", "-pix_fmt", "rgb24")
        row = 3 * width
        frames = [pixels[i:i + row * height] for i in range(0, len(pixels), row * height)]
        return [[frame[y * row:(y + 1) * row] for y in range(height)] for frame in frames]

    def sound(self, name):
        return array.array("f", self.read("-i", name, "-f", "f32le", "-ac", "1", "-ar", str(SOUND_HZ)))

    def test_frames_of_the_same_time_follow_each_other(self):
        """Frames that are stored in another order than they are shown have no times in an AVI."""
        self.run_in_folder(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", f"testsrc2=size=320x240:rate={RATE_HZ}:duration=2",
                            "-c:v", "mpeg4", "-bf", "2", "film.avi"])
        for name in ("shown.mp4", "shown.mkv"):
            said = self.spidartrack("show", "film.avi", name)
            self.assertNotIn(".;", said)
            self.assertEqual(int(self.streams(name)["video"]["nb_read_packets"]), RATE_HZ * SECONDS)

    def test_pictures_have_outline_arrow_and_curve(self):
        self.make_sounding("film.avi")
        said = self.spidartrack("show", "film.avi", "shown.mp4")
        self.assertRegex(said, r"(?m)^film.avi: shown.mp4; \d+ % of its frames are felt")
        video = self.streams("shown.mp4")["video"]
        self.assertEqual((video["codec_name"], video["width"], video["height"], int(video["nb_read_packets"])),
                         ("h264", WIDTH, HEIGHT, RATE_HZ * SECONDS))
        self.assertAlmostEqual(float(video["duration"]), SECONDS, delta=.5 / RATE_HZ)
        before, after = self.pictures("film.avi"), self.pictures("shown.mp4")
        self.assertEqual(len(after), len(before))
        self.assertGreater(orange(after[-1][LOWER]), CURVE_PX)
        outlines = [orange(rows[:HEIGHT * 4 // 5]) for rows in after[10::10]]
        self.assertGreater(max(outlines), 100)
        self.assertEqual([orange(rows) for rows in before[10::10]], [0] * len(outlines))

    def test_properties_follow_two_dashes_and_presets_are_among_them(self):
        self.make_sounding("film.avi")
        self.assert_said("max-force=2: there is no such film; properties follow --: spidartrack show FILM TO -- max-force=2",
                         "show", "film.avi", "shown.mp4", "max-force=2", status=2)
        self.assert_said("not expected: more.mp4", "show", "film.avi", "shown.mp4", "more.mp4", status=2)
        self.assert_said('there is no preset "gentel"; known are', "show", "film.avi", "shown.mp4", "--", "preset=gentel",
                         status=2)
        self.spidartrack("show", "film.avi", "shown.mp4", "--", "preset=gentle")
        self.spidartrack("record", "film.avi", "--", "preset=gentle", "motion=camera")
        # A track with the same settings is kept, and one with others is refused.
        self.spidartrack("record", "film.avi", "--", "alpha=0.00083", "motion=camera")
        self.spidartrack("record", "film.avi", "--", "motion=camera", status=1)

    def test_sound_that_the_container_takes_is_copied(self):
        self.make_sounding("film.mov", "! avenc_aac", "qtmux")
        for name in ("shown.mp4", "shown.mkv"):
            self.spidartrack("show", "film.mov", name)
            kept, original = ((self.read("-i", film, "-map", "0:a", "-c", "copy", "-f", "framehash").split(b"#")[-1]
                               .splitlines()[1:]) for film in (name, "film.mov"))
            self.assertGreater(len(original), 40)
            self.assertEqual([line.split(b",")[-1] for line in kept], [line.split(b",")[-1] for line in original])

    def test_other_sound_is_heard_at_the_same_time(self):
        self.make_sounding("film.avi")
        self.spidartrack("show", "film.avi", "shown.mp4")
        streams = self.streams("shown.mp4")
        self.assertEqual(streams["audio"]["codec_name"], "aac")
        samples = self.sound("shown.mp4")
        tick = next(i for i in range(SOUND_HZ // 2, len(samples)) if abs(samples[i]) > .1)
        # Two blocks of AAC: an encoder delays by one, and hears the tick one before it.
        self.assertAlmostEqual(tick / SOUND_HZ, 1, delta=2 * 1024 / SOUND_HZ)

    def test_every_sound_is_kept_and_its_encoder_says_nothing(self):
        self.run_in_folder("ffmpeg -nostdin -v error -f lavfi -i testsrc2=size=320x240:rate=25:duration=2 -f lavfi -i "
                           "sine=d=2:f=400 -f lavfi -i sine=d=2:f=800 -map 0 -map 1 -map 2 -c:v mpeg4 -c:a:0 aac "
                           "-c:a:1 flac film.mkv")
        for name in ("shown.mp4", "shown.mkv"):
            said = self.spidartrack("show", "film.mkv", name)
            self.assertNotIn("OpenH264", said)
            kinds = self.run_in_folder(["ffprobe", "-v", "error", "-show_entries", "stream=codec_name", "-of", "csv=p=0", name])
            self.assertEqual(sorted(kinds.split()), ["aac", "aac", "h264"])

    def test_subtitles_are_kept_or_drawn_and_the_curve_keeps_clear_of_them(self):
        self.make_sounding("film.avi")
        self.path("film.srt").write_text("1\n00:00:00,200 --> 00:00:00,900\n<i>Here</i> & there\n\n"
                                         "2\n00:00:01,200 --> 00:00:01,900\nüber <b>alles</b>\n", encoding="utf-8")
        for film, codec in (("film.mkv", "srt"), ("film.mp4", "mov_text"), ("styled.mkv", "ass")):
            self.run_in_folder(f"ffmpeg -nostdin -v error -i film.avi -i film.srt -map 0:v -map 1 -c:v copy -c:s {codec} {film}")
            for name in ("shown.mp4", "shown.mkv"):
                with self.subTest(film, to=name):
                    self.assertNotIn("left out", self.spidartrack("show", film, name, "--force"))
                    text = re.sub("<font[^>]*>|</font>", "", self.read("-i", name, "-map", "0:s", "-f", "srt").decode())
                    self.assertIn("00:00:00,200 --> 00:00:00,900\nHere & there\n", text)
                    # The muxer of MP4 lets the last one end earlier.
                    self.assertRegex(text, "00:00:01,200 --> 00:00:01,...\nüber alles\n")
            self.assertGreater(orange(self.pictures("shown.mp4")[-1][UPPER]), CURVE_PX)
        self.spidartrack("show", "film.mkv", "drawn.mp4", "--subtitles")
        self.assertNotIn("subtitle", self.streams("drawn.mp4"))
        drawn, kept = (self.pictures(name)[round(1.5 * RATE_HZ)] for name in ("drawn.mp4", "shown.mp4"))
        self.assertGreater(orange(drawn[UPPER]), CURVE_PX / 2)
        white = [sum(row[i] > 200 for row in rows[LOWER] for i in range(0, 3 * WIDTH, 3)) for rows in (drawn, kept)]
        self.assertGreater(white[0], white[1] + 200)  # of ten letters
        self.assertIn("it has no subtitles to draw", self.spidartrack("show", "film.avi", "plain.mp4", "--subtitles"))

    def test_films_of_every_kind(self):
        self.make_film("silent.avi")
        self.spidartrack("show", "silent.avi", "silent.mp4")
        self.assertEqual(set(self.streams("silent.mp4")), {"video"})
        self.make_sounding("odd.avi", width=161, height=121)
        self.spidartrack("show", "odd.avi", "odd.mkv", "--", "motion=camera", "max-force=2")
        video = self.streams("odd.mkv")["video"]
        for size, wanted in ((video["width"], 161), (video["height"], 121)):
            self.assertEqual((size % 2, abs(size - wanted)), (0, 1))
        self.assertEqual(int(video["nb_read_packets"]), RATE_HZ * SECONDS)

    def test_what_is_wrong_is_said_and_leaves_no_file(self):
        self.make_film()
        for words, why, status in (
                (("film.avi", "a.avi"), "a.avi: is to end in .mp4 or .mkv", 2),
                (("none.avi", "a.mp4"), "none.avi: there is no such file", 1),
                (("film.avi", "a.mp4", "--", "overlay=none"), "changes nothing", 2),
                (("film.avi", "none/a.mp4"), "none", 1)):
            self.assert_said(why, "show", *words, status=status)
        self.path("film.avi").rename(self.path("film.mkv"))
        self.assert_said("film.mkv: is to be another file than film.mkv", "show", "film.mkv", "film.mkv")
        self.path("cut.mkv").write_bytes(self.path("film.mkv").read_bytes()[:-2000])
        self.assert_said("its end is missing", "show", "cut.mkv", "cut.mp4")
        self.path("text.mkv").write_text("no film")
        self.spidartrack("show", "text.mkv", "text.mp4", status=1)
        self.assertEqual(self.files(), {"film.mkv", "cut.mkv", "text.mkv"})

    def test_a_film_that_ends_at_its_first_picture_is_named_and_gstreamer_says_nothing(self):
        self.make_film(frames=1)
        said = self.spidartrack("show", "film.avi", "film.mp4", status=1)
        self.assertIn("film.avi: it is a single picture", said)
        self.assertNotIn("WARNING", said)
        self.assertEqual(self.files(), {"film.avi"})

    def test_a_missing_encoder_is_named_with_its_package(self):
        self.make_film()
        installed = json.loads(self.run_in_folder(
            ["/usr/bin/python3", "-c", "import gi, json; gi.require_version('Gst', '1.0'); from gi.repository import Gst;"
             "Gst.init(None); r = Gst.Registry.get(); print(json.dumps([p.get_filename() for p in r.get_plugin_list()]))"]))
        self.path("plugins").mkdir()
        for file in map(pathlib.Path, filter(None, installed)):
            if not file.name.startswith(("libgstx264", "libgstopenh264", "libgstspidar")):
                self.path("plugins").joinpath(file.name).symlink_to(file)
        without = dict(os.environ, GST_PLUGIN_SYSTEM_PATH=str(self.path("plugins")), GST_REGISTRY=str(self.path("registry")))
        self.assert_said("no encoder of H.264: install gstreamer1.0-plugins-ugly", "show", "film.avi", "a.mp4", env=without)


if __name__ == "__main__":
    unittest.main()
