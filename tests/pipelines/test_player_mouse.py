# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The mouse in the windows of players that are separate programs: a real X server, sinks that send what the mouse does,
and xdotool, which moves it."""

import csv
import math
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import screen
import track_case
from screen import comes

WIDTH, HEIGHT, RATE = 480, 270, 25
# Three discs that circle about places of their own, a third of a turn apart, so that each moves in another direction than
# the others at any time. In pixels from the middle of the picture.
MIDDLES = ((-150, -70), (150, -70), (0, 75))
CIRCLE_PX, DISC_PX, TURN_FRAMES, TURNS = 24, 28, 50, 60


def angle(disc, frame):
    return 2 * math.pi * (frame / TURN_FRAMES + disc / len(MIDDLES))


def one_turn():
    """The frames of a turn. The background tells that the camera rests."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    textures = [np.kron(random.integers(20, 236, (64, 64)), np.ones((8, 8))).astype(np.uint8) for _ in range(4)]
    for frame in range(TURN_FRAMES):
        picture = textures[3][y, x]
        for disc, (middle_x, middle_y) in enumerate(MIDDLES):
            at = angle(disc, frame)
            on_x = x - WIDTH / 2 - middle_x - round(CIRCLE_PX * math.cos(at))
            on_y = y - HEIGHT / 2 - middle_y - round(CIRCLE_PX * math.sin(at))
            inside = on_x ** 2 + on_y ** 2 < DISC_PX ** 2
            picture[inside] = textures[disc][on_y[inside].astype(int) + 100, on_x[inside].astype(int) + 100]
        yield picture.tobytes()


def last_rows(path, most):
    """Whole rows at the end of a CSV file that is still written, which have at most 2048 characters."""
    if not os.path.exists(path):
        return []
    with open(path, "rb") as file:
        names = file.readline()
        begin = max(file.seek(0, os.SEEK_END) - 2048 * (most + 1), len(names))
        file.seek(begin)
        lines = file.read().decode().split("\n")[begin > len(names):-1]  # without the parts of rows at both ends
    return list(csv.DictReader(lines, names.decode().strip().split(",")))[-most:]


class PlayerMouse(screen.ScreenCase, track_case.TrackCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.film = folder.name + "/film.avi"
        subprocess.run(["gst-launch-1.0", "-q", *"fdsrc ! rawvideoparse format=gray8 width=480 height=270 framerate=25/1 ! "
                        f"jpegenc ! avimux ! filesink location={cls.film}".split()],
                       input=b"".join(one_turn()) * TURNS, check=True)

    def setUp(self):
        super().setUp()
        self.trace = self.path("trace.csv")

    def start(self, command):
        player = subprocess.Popen(command)
        self.addCleanup(player.wait)
        self.addCleanup(player.terminate)
        self.assertTrue(comes(screen.windows), "no window")
        shape = screen.xdotool("getwindowgeometry", "--shell", screen.windows()[-1])
        self.window = {name: int(value) for name, value in (line.split("=") for line in shape.split())}
        self.assertTrue(comes(lambda: last_rows(self.trace, 1)), "no frame")

    def launch(self, sink, properties):
        # No frame is left out on a slow machine.
        return ["gst-launch-1.0", "-q", *f"filesrc location={self.film} ! decodebin ! spidarmotion {properties} "
                f"trace={self.trace} ! videoconvert ! {sink} qos=false".split()]

    def mouse(self, place):
        """To a place of the picture, which fills the window."""
        screen.xdotool("mousemove", self.window["X"] + round(place[0] * self.window["WIDTH"]),
                       self.window["Y"] + round(place[1] * self.window["HEIGHT"]))

    @staticmethod
    def place_of(disc):
        return .5 + MIDDLES[disc][0] / WIDTH, .5 + MIDDLES[disc][1] / HEIGHT

    @staticmethod
    def felt(row):
        """The disc that moves most like what was felt in this row, measured between two frames."""
        frame = 1e-9 * int(row["stream_time_ns"]) * RATE
        x, y = float(row["velocity_x_px_s"]), float(row["velocity_y_px_s"])
        return max(range(len(MIDDLES)),
                   key=lambda disc: -x * math.sin(angle(disc, frame - .5)) + y * math.cos(angle(disc, frame - .5)))

    def comes_to_feel(self, disc):
        """Whether it comes to be felt, and stays so for half a turn."""
        half = TURN_FRAMES // 2
        return comes(lambda: [self.felt(row) for row in last_rows(self.trace, half)] == [disc] * half)

    def expect_mouse_chooses(self):
        for disc in range(len(MIDDLES)):
            self.mouse(self.place_of(disc))
            self.assertTrue(self.comes_to_feel(disc), disc)

    def expect_mouse_of_sink(self, sink):
        shows = self.run_in_folder(f"gst-launch-1.0 -q videotestsrc num-buffers=1 ! videoconvert ! {sink}", None)
        if self.status != 0:
            self.skipTest(f"{sink} shows nothing here: {shows}")
        self.start(self.launch(sink, "device=none motion=objects pointer=mouse"))
        self.expect_mouse_chooses()

    def test_in_ximagesink(self):
        """What a click does, test_choice.cpp shows."""
        self.expect_mouse_of_sink("ximagesink")

    def test_in_xvimagesink(self):
        self.expect_mouse_of_sink("xvimagesink")

    def test_in_glimagesink(self):
        self.expect_mouse_of_sink("glimagesink")

    @unittest.skipUnless(shutil.which("gst-play-1.0"), "needs gstreamer1.0-plugins-base-apps")
    def test_in_a_player_that_knows_nothing_of_it(self):
        self.start([os.environ["SPIDAR_FEEL"], "device=none", "motion=objects", "pointer=mouse", f"trace={self.trace}", "--",
                    "gst-play-1.0", "--quiet", "--no-interactive", "--videosink=ximagesink qos=false", self.film])
        self.expect_mouse_chooses()


if __name__ == "__main__":
    unittest.main()
