# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A picture that moves at a known time, for the least delay of a force that is noticed."""

import numpy as np

from clip_player import SINKS, Gst
from perception import PAUSE_S, PULSE_S, RAMP_S, share_of_pulse

WIDTH, HEIGHT, SIZE = 640, 360, 60  # px
FRAMES_S = 60
DISTANCE = 300  # px, which a pulse lasts
AHEAD_S = 0.2  # pictures are there so long before the first of them is due
START_S = 10  # until the first picture is on the screen


def pictures():
    """A square that moves to the right as fast as the force of a pulse is strong."""
    shares = np.array([share_of_pulse(n / FRAMES_S) for n in range(1 + round((PULSE_S + 2 * RAMP_S) * FRAMES_S))])
    for x in np.round((WIDTH - DISTANCE - SIZE) / 2 + DISTANCE * np.cumsum(shares) / shares.sum()).astype(int):
        picture = np.full((HEIGHT, WIDTH), 64, np.uint8)
        picture[(HEIGHT - SIZE) // 2:(HEIGHT + SIZE) // 2, x:x + SIZE] = 220
        yield picture.tobytes()


class MovingSquare:
    """A context manager: the window is there from its beginning to its end. `output`: one of clip_player.SINKS."""

    def __init__(self, output):
        self.pictures = list(pictures())
        self.pipeline = Gst.parse_launch(f"appsrc name=source format=time max-bytes=0 caps=video/x-raw,format=GRAY8,"
                                         f"width={WIDTH},height={HEIGHT},framerate={FRAMES_S}/1 ! videoconvert ! {SINKS[output]}")
        self.pipeline.use_clock(Gst.SystemClock.obtain())  # which is time.monotonic_ns()

    def push(self, picture, time_ns):
        buffer = Gst.Buffer.new_wrapped(picture)
        buffer.pts, buffer.duration = time_ns, Gst.SECOND // FRAMES_S
        self.pipeline.get_by_name("source").emit("push-buffer", buffer)

    def __enter__(self):
        """Raises RuntimeError if there is no screen."""
        self.push(self.pictures[0], 0)
        self.pipeline.set_state(Gst.State.PLAYING)
        if self.pipeline.get_state(START_S * Gst.SECOND)[0] != Gst.StateChangeReturn.SUCCESS:
            self.__exit__()
            raise RuntimeError("no window opens for the square that moves: is there a screen?")
        return self

    def __exit__(self, *_):
        self.pipeline.set_state(Gst.State.NULL)

    def move(self, push):
        """Calls `push` with the time, of time.monotonic_ns(), at which the square begins to move, before that time. Raises
        RuntimeError if the window was closed."""
        if message := self.pipeline.bus.pop_filtered(Gst.MessageType.ERROR):
            raise RuntimeError(f"the square that moves is gone: {message.parse_error()[0].message}")
        base_ns = self.pipeline.get_base_time()
        begin_ns = self.pipeline.get_clock().get_time() - base_ns + int((AHEAD_S + PAUSE_S) * Gst.SECOND)
        self.push(self.pictures[0], begin_ns - int(PAUSE_S * Gst.SECOND))
        for n, picture in enumerate(self.pictures):
            self.push(picture, begin_ns + n * Gst.SECOND // FRAMES_S)
        push(base_ns + begin_ns)
