# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Films as videorate repeats their frames, whose force is that of the plain film, and formats that are not read."""

import unittest

import gst_case
from gst_case import Gst

BALL = "videotestsrc pattern=ball num-buffers={} ! video/x-raw,format={},width=320,height=240,framerate={}/1"


class Formats(gst_case.GstCase):
    def feel(self, source):
        """x and y of each frame's force."""
        outcome = self.play(self.parse(f"{source} ! spidarmotion device=none ! fakesink"))
        self.assertEqual(outcome.error, "")
        return [value for force in outcome.forces for value in force]

    def assert_same_force(self, felt, plain, share, learnt):
        """Within so much of the plain film's, root mean square, from frame number `learnt` on."""
        pairs = list(zip(felt, plain))[2 * learnt:]
        self.assertGreater(len(pairs), 50)
        whole = sum(other ** 2 for _, other in pairs)
        self.assertGreater(whole, .1 * len(pairs), "there is something to compare")
        self.assertLess(sum((one - other) ** 2 for one, other in pairs), share ** 2 * whole)

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
