# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Failures of the matrix that are known: the check, the films that it concerns, words of the message, and the cause.
The table lists them with counts. An entry of KNOWN that no film of `--meeting` needs any more is a failure, so that it is
removed."""


def of(**values):
    """Films with these values, each one of several separated by |; an underscore stands for a space."""
    wanted = {name.replace("_", " "): value.split("|") for name, value in values.items()}
    return lambda kind: all(kind[name] in value for name, value in wanted.items())


RELEASE = "1.22"  # of GStreamer, in Debian 12
B_FRAMES = of(container="avi", pictures="MPEG-4")
NO_TIMES = "AVI has no times for B-frames: avidemux makes them up, two pictures have the same"
CRITICAL = "mpeg4videoparse prints a critical message about some packets"

# The check `pictures` plays films without the element: its failures are GStreamer's.
KNOWN = (
    ("pictures", of(times="edit list"), "pictures of",
     "qtdemux ends a film whose first pictures an edit list hides too early: the last pictures are not shown"),
    ("pictures", of(container="mkv|webm"), "beside its time",
     "matroskademux cuts the first picture where the sound begins: its time is that of the first sound"),
    *((check, B_FRAMES, "", NO_TIMES) for check in ("pictures", "analysed", "own_track", "felt")),
)
# That only films of `--whole` have.
RARE = (
    *((check, of(container="fragmented mp4", pictures="AV1"), words, "the last picture is lost in qtdemux or av1dec")
      for check, words in (("pictures", "pictures of"), ("felt", "off the track"))),
    ("track_in_time", B_FRAMES, "", NO_TIMES),
    *((check, of(pictures="MPEG-4"), "reader->size", CRITICAL) for check in ("record", "own_track", "felt")),
)
