# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Failures of the matrix that are known: the check, the films that it concerns, words of the message, the reason. The
table lists them with counts. An entry that no film needs any more is named, so that it is removed."""


def of(**values):
    """Films with these values, each one of several separated by |; an underscore stands for a space."""
    wanted = {name.replace("_", " "): value.split("|") for name, value in values.items()}
    return lambda kind: all(kind[name] in value for name, value in wanted.items())


ANY = of()
NO_UTF_8, GAPLESS = of(name="not UTF-8"), of(player="gapless")
LENGTH = "a track knows its film by the film's duration only"

KNOWN = (
    ("pictures", of(times="edit list"), "pictures of",
     "qtdemux ends a film whose first pictures an edit list hides too early: the last pictures are not shown"),
    ("pictures", of(container="mkv|webm"), "beside its time",
     "matroskademux cuts the first picture where the sound begins: its time is that of the first sound"),
    *((check, of(container="avi", pictures="MPEG-4"), "", "AVI has no times for B-frames, avidemux makes them up")
      for check in ("pictures", "analysed", "track_in_time", "own_track", "felt")),
    ("pictures", of(container="fragmented mp4", pictures="AV1"), "pictures of",
     "the last picture is lost in qtdemux or av1dec"),
    ("felt", of(container="m2ts|ts", player="playbin3"), "shows", "playbin3 does not show the first picture"),
    ("felt", of(container="flv", player="gapless"), "shows", "playbin3 does not show the last picture"),
    ("analysed", of(sound_time="ends 5 s after"), "no force in picture",
     "gap events of sound that goes on stop the motion of the last pictures, which the decoder still holds"),
    ("track_in_time", of(sound_time="ends 5 s after"), "not in the track", "the same"),
    ("felt", of(sound_time="ends 5 s after"), "pictures", "the decoder shows the last pictures when the sound ends"),
    ("record", of(pictures="MPEG-4"), "reader->size", "a critical message of GStreamer's parser of MPEG-4"),
    ("record", NO_UTF_8, "could not set property", "the name of a film has to be UTF-8"),
    ("info", of(name="newline"), "JSON", "info --json writes a newline in a name as it is"),
    ("merge", ANY, "'language': 'eng'", "the merged track is marked as English"),
    ("merge", of(extra="SRT|ASS"), "takes no stream of text", "merge refuses films with subtitles"),
    ("merge", ANY, "is that of another film", LENGTH),
    ("merge", of(container="flv"), "has no sound", "merge does not find the sound of some FLV films"),
    ("merge", of(container="fragmented mp4"), "Could not multiplex", "matroskamux fails, and merge does not say why"),
    ("plot", ANY, "is another film", LENGTH),
    ("plot", ANY, "has no picture at a time", LENGTH),
    ("own_track", ANY, "is not felt", LENGTH),
    ("felt", of(player="track=auto"), "the track lasts", LENGTH),
    ("other_film", ANY, "of another film", LENGTH),
    ("felt", GAPLESS, "nothing is felt", "the next film cancels what waits for the screen"),
    ("damaged", of(container="avi"), "status 0", "half an AVI film is recorded as whole"),
    ("damaged", of(container="flv"), "Internal data stream error", "the cause is not said"),
)
