# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Films in the formats of decoders: 8, 10 and 12 bits, any chroma subsampling, grey of 16 bits, video range and full
range; and as videorate repeats them. The force is that of the plain 8-bit film."""

import unittest

import gst_case
from gst_case import Gst

BALL = "videotestsrc pattern=ball num-buffers={} ! video/x-raw,format={},width=320,height=240,framerate={}/1"
FILM = BALL.format(30, "I420", 25) + ",colorimetry=(string)2:4:16:4 ! videoconvert ! video/x-raw,format="
# So that hardly any of the difference is due to coding.
CODED = " ! vp9enc end-usage=cq cq-level=4 min-quantizer=0 max-quantizer=8 cpu-used=8 deadline=1 ! decodebin"


class Formats(gst_case.GstCase):
    def feel(self, source, wanted_format=None):
        """x and y of each frame's force; checks that the film came in this format, as it is decoded."""
        pipeline = self.parse(f"{source} ! spidarmotion name=motion device=none ! fakesink")
        formats = []
        pipeline.get_by_name("motion").get_static_pad("sink").connect(
            "notify::caps", lambda pad, _: pad.get_current_caps() and formats.append(
                pad.get_current_caps().get_structure(0).get_string("format")))
        outcome = self.play(pipeline)
        self.assertEqual(outcome.error, "")
        if wanted_format:
            self.assertEqual(formats[-1], wanted_format)
        return [value for force in outcome.forces for value in force]

    def assert_same_force(self, felt, plain, share=.05, learnt=0):
        """Within so much of the plain film's, root mean square, from frame number `learnt` on."""
        pairs = list(zip(felt, plain))[2 * learnt:]
        self.assertGreater(len(pairs), 50)
        whole = sum(other ** 2 for _, other in pairs)
        self.assertGreater(whole, .1 * len(pairs), "there is something to compare")
        self.assertLess(sum((one - other) ** 2 for one, other in pairs), share ** 2 * whole)

    def test_decoders_of_vp9_are_felt_as_the_8_bit_film(self):
        plain = self.feel(FILM + "I420" + CODED)
        for name in ("I420_10LE", "I420_12LE", "I422_10LE", "I422_12LE", "Y444", "Y444_10LE", "Y444_12LE"):
            with self.subTest(name):
                self.assert_same_force(self.feel(FILM + name + CODED, name), plain)

    def test_grey_of_16_bits_is_felt_as_of_8(self):
        plain = self.feel(FILM + "GRAY8 ! pngenc ! decodebin")
        self.assert_same_force(self.feel(FILM + "GRAY16_BE ! pngenc ! decodebin", "GRAY16_BE"), plain)

    def test_full_range_is_felt_as_video_range(self):
        for name in ("I420", "I420_10LE", "P010_10LE"):
            with self.subTest(name):
                # By way of RGB, for videoconvert of GStreamer 1.22 does not change the range alone.
                film = f"{FILM}RGB ! videoconvert ! video/x-raw,format={name},colorimetry="
                self.assert_same_force(self.feel(film + "(string)1:4:16:4", name), self.feel(film + "(string)2:4:16:4"))

    def test_what_videorate_repeats_is_felt_as_the_plain_film(self):
        film = BALL.format(60, "GRAY8", 24)
        plain = self.feel(film)
        self.assertEqual(len(plain), 120)
        for rate in (60, 30, 50):
            with self.subTest(rate):
                # Of a frame that is flagged as repeated nothing is posted: both films have as many messages.
                felt = self.feel(f"{film} ! videorate ! video/x-raw,framerate={rate}/1")
                self.assertGreaterEqual(len(felt), 110)
                self.assert_same_force(felt[:110], plain, .1, 15)

    def test_other_formats_need_a_converter(self):
        source = "videotestsrc num-buffers=30 pattern=ball ! video/x-raw,format=RGB16 ! "
        with self.assertRaisesRegex(gst_case.gi.repository.GLib.GError, "could not link"):
            Gst.parse_launch(source + "spidarmotion ! fakesink")
        self.assertEqual(len(self.feel(source + "videoconvert")), 60)


if __name__ == "__main__":
    unittest.main()
