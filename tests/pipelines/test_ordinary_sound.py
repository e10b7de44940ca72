# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Sound for ears that comes where a haptic track is read is not felt, whatever has converted it; and what nothing says
to be a track becomes one by what the message says."""

import math
import unittest

import gst_case
import track_case

FRAMES = 10
VIDEO = f"videotestsrc pattern=ball num-buffers={FRAMES} ! video/x-raw,width=64,height=48,framerate=25/1 ! "
CONVERTED = "decodebin ! audioconvert ! audioresample ! spidarsink"
SECONDS = .4  # as long as the film


def tone(channels, rate_Hz):
    """80 Hz, much of which is felt when it becomes force."""
    return [(.5 * math.sin(2 * math.pi * 80 * n / rate_Hz),) * channels for n in range(round(SECONDS * rate_Hz))]


class OrdinarySound(gst_case.GstCase):
    # Name, channels and rate in Hz: a telephone, music, a film, and sound that the sink takes as it is.
    SOUNDS = (("call.wav", 1, 8000), ("music.wav", 2, 44100), ("film.wav", 6, 48000), ("six.wav", 6, 8000))

    def make_sound(self, name, channels, rate_Hz):
        track_case.write_wav(self.path(name), tone(channels, rate_Hz), rate_Hz, marked=False)
        return self.path(name)

    def played(self, line):
        """How the line has played, and the largest force, N."""
        pipeline = self.parse(line)
        outcome = self.play(pipeline)
        self.assertTrue(outcome.eos, outcome.error)
        return outcome, self.largest_N(*pipeline.watched)

    def expect_felt(self, line):
        played = (self.played(line) for _ in track_case.tries())
        self.assertTrue(any(force_N > .5 and not outcome.warnings for outcome, force_N in played))

    @staticmethod
    def largest_N(path):
        return max(math.hypot(*gst_case.vector(row, "commanded_force")) for row in gst_case.read_ticks(path))

    def test_the_sink_feels_no_sound_that_was_converted_to_a_track(self):
        for sound in self.SOUNDS:
            with self.subTest(sound):
                outcome, force_N = self.played(f"filesrc location={self.make_sound(*sound)} ! {CONVERTED}")
                self.assertEqual(force_N, 0)
                self.assertEqual(len(outcome.warnings), 1, outcome.warnings)
                self.assertIn("nothing says that it is a haptic track", outcome.warnings[0])
                self.assertIn("accept-unmarked=true", outcome.warnings[0])

    def test_a_player_with_the_sink_as_its_output_of_sound_shows_the_film(self):
        self.gst(f"matroskamux name=mux ! filesink location=film.mkv {VIDEO} jpegenc ! mux.",
                 "audiotestsrc num-buffers=20 samplesperbuffer=960 freq=80 ! audio/x-raw,rate=48000,channels=6,"
                 "channel-mask=(bitmask)0x3f ! audioconvert ! mux.")
        ticks = self.path("ticks.csv")
        outcome = self.play(f"playbin uri=file://{self.path('film.mkv')} video-sink=fakesink "
                            f"audio-sink=\"spidarsink haptic-trace={ticks}\"")
        self.assertTrue(outcome.eos, outcome.error)
        self.assertEqual((self.largest_N(ticks), len(outcome.warnings)), (0, 1))

    @track_case.needs("ffmpeg")
    def test_a_mark_of_the_container_does_not_mark_its_sound(self):
        """Where a program makes the tags of a track those of the film."""
        self.make_sound("film.wav", 6, 48000)
        self.run_in_folder("ffmpeg -nostdin -v error -i film.wav -metadata comment='HAPTIC_FULL_SCALE=10 N, 1 N m' film.mka")
        _, force_N = self.played(f"filesrc location={self.path('film.mka')} ! {CONVERTED}")
        self.assertEqual(force_N, 0)

    def test_the_property_takes_it(self):
        sound = self.make_sound("six.wav", 6, 8000)
        self.expect_felt(f"filesrc location={sound} ! wavparse ! spidarsink accept-unmarked=true")

    def test_a_film_is_analysed_and_not_felt_by_its_sound(self):
        sound = self.make_sound("six.wav", 6, 8000)
        outcome = self.play(f"{VIDEO} spidarmotion track={sound} ! queue ! fakesink sync=true")
        self.assertEqual((len(outcome.warnings), len(outcome.forces)), (1, FRAMES))
        self.assertIn("Nothing says that this sound of 8000 Hz is a haptic track", outcome.warnings[0])
        # No track was asked for, and there is none to warn of.
        self.gst(f"matroskamux name=mux ! filesink location=film.mkv {VIDEO} jpegenc ! mux.",
                 "filesrc location=six.wav ! wavparse ! mux.")
        outcome = self.play(f"filesrc location={self.path('film.mkv')} ! matroskademux ! jpegdec ! videoconvert ! "
                            "spidarmotion track=auto ! queue ! fakesink sync=true")
        self.assertEqual((outcome.warnings, len(outcome.forces)), ([], FRAMES))

    @track_case.needs("ffmpeg")
    def test_the_commands_refuse_it_until_it_is_marked_as_they_say(self):
        self.make_sound("six.wav", 6, 8000)
        for command in ("info", "check"):
            self.assert_said("Nothing says that this sound", command, "six.wav")
        said = self.spidartrack("convert", "six.wav", "a.flac", status=1)
        self.assertFalse(self.path("a.flac").exists())
        mark = said[said.index("ffmpeg"):].strip().rstrip(".").replace("FILE", "six.wav")
        self.run_in_folder(mark.replace("ffmpeg", "ffmpeg -nostdin -v error"))
        self.spidartrack("convert", "MARKED.wav", "a.flac")
        self.expect_felt(f"filesrc location={self.path('MARKED.wav')} ! wavparse ! spidarsink")


if __name__ == "__main__":
    unittest.main()
