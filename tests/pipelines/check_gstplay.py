# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Tests GstPlay, on which many players are based, gst-play-1.0, and frame steps in playbin."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import gi
    gi.require_version("Gst", "1.0")
    from gi.repository import GLib, Gst
except (ImportError, ValueError) as missing:
    print(f"skipped: {missing}; Debian has it in python3-gi and gir1.2-gstreamer-1.0")
    sys.exit(77)


def write_film(folder):
    """A picture that moves as a whole, for a second."""
    film = os.path.join(folder, "film.avi")
    pipeline = Gst.parse_launch(
        "videotestsrc pattern=smpte horizontal-speed=2 num-buffers=25 ! video/x-raw,width=160,"
        f"height=120,framerate=25/1 ! jpegenc ! avimux ! filesink location={film}")
    pipeline.set_state(Gst.State.PLAYING)
    message = pipeline.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE,
                                              Gst.MessageType.EOS | Gst.MessageType.ERROR)
    pipeline.set_state(Gst.State.NULL)
    assert message.type == Gst.MessageType.EOS, message.parse_error()
    return film


def commanded_N(trace):
    """The force of each tick."""
    with open(trace, newline="") as rows:
        return [sum(float(row[f"commanded_force_{axis}_N"]) ** 2 for axis in "xyz") ** 0.5
                for row in csv.DictReader(rows)]


def check_felt(trace):
    force_N = commanded_N(trace)
    assert max(force_N) > 0.1, max(force_N)
    assert force_N[-1] == 0, "at rest when it ends"


def play_to_the_end(play, film):
    """Half of it at twice the speed; `play` is a GstPlay.Play."""
    bus = play.get_message_bus()
    play.set_uri(Gst.filename_to_uri(film))
    play.pause()
    steps = {GstPlay.PlayState.PAUSED: lambda: (play.set_rate(2.0), play.seek(Gst.SECOND // 2),
                                            play.play())}
    while True:
        message = bus.timed_pop(Gst.CLOCK_TIME_NONE)
        kind = GstPlay.PlayMessage.parse_type(message)
        assert kind != GstPlay.PlayMessage.ERROR, message.get_structure().to_string()
        if kind == GstPlay.PlayMessage.STATE_CHANGED:
            steps.pop(GstPlay.PlayMessage.parse_state_changed(message), lambda: None)()
        if kind == GstPlay.PlayMessage.END_OF_STREAM:
            return


def check_gst_play(film, folder):
    trace = os.path.join(folder, "gstplay.csv")
    motion = Gst.parse_launch(f"spidarmotion motion=mean haptic-trace={trace}")
    play = GstPlay.Play.new(None)
    play.get_pipeline().set_property("video-filter", motion)
    for sink in "video-sink", "audio-sink":
        play.get_pipeline().set_property(sink, Gst.parse_launch("fakesink sync=true"))
    play_to_the_end(play, film)
    play.stop()
    play.get_pipeline().get_state(Gst.CLOCK_TIME_NONE)
    play.get_pipeline().set_state(Gst.State.NULL)
    check_felt(trace)


def check_program(program, film, folder):
    """It has no option for a filter, but takes a sink of several elements."""
    trace = os.path.join(folder, "program.csv")
    subprocess.run([program, "--quiet", "--no-interactive", "--audiosink=fakesink",
                    f"--videosink=spidarmotion motion=mean haptic-trace={trace} ! fakesink sync=true", film],
                   check=True, timeout=60)
    check_felt(trace)


def check_steps(name, film, folder):
    """The first ten frames are stepped over: the force begins with the eleventh."""
    trace = os.path.join(folder, f"{name}.csv")
    player = Gst.ElementFactory.make(name)
    screen = Gst.parse_launch("fakesink sync=true")
    player.set_property("uri", Gst.filename_to_uri(film))
    player.set_property("video-filter",
                        Gst.parse_launch(f"spidarmotion motion=mean haptic-trace={trace}"))
    player.set_property("video-sink", screen)
    player.set_state(Gst.State.PAUSED)
    player.get_state(Gst.CLOCK_TIME_NONE)
    screen.send_event(Gst.Event.new_step(Gst.Format.BUFFERS, 10, 1.0, True, False))
    player.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.STEP_DONE)
    player.set_state(Gst.State.PLAYING)
    message = player.bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE,
                                            Gst.MessageType.EOS | Gst.MessageType.ERROR)
    player.set_state(Gst.State.NULL)
    assert message.type == Gst.MessageType.EOS, message.parse_error()
    with open(trace, newline="") as rows:
        running_ns = [int(row["running_ns"]) for row in csv.DictReader(rows) if row["playing"] == "1"]
    assert running_ns[0] >= 10 * Gst.SECOND // 25, running_ns[0]
    check_felt(trace)


Gst.init(None)
skipped = []
with tempfile.TemporaryDirectory() as temporary:
    clip = write_film(temporary)
    for playbin in "playbin", "playbin3":
        check_steps(playbin, clip, temporary)
    program = shutil.which("gst-play-1.0")
    if program:
        check_program(program, clip, temporary)
    else:
        skipped.append("gst-play-1.0: Debian has it in gstreamer1.0-plugins-base-apps")
    try:
        gi.require_version("GstPlay", "1.0")
        from gi.repository import GstPlay
        check_gst_play(clip, temporary)
    except ValueError as missing:
        skipped.append(f"{missing}; Debian has it in gir1.2-gst-plugins-bad-1.0")
for reason in skipped:
    print(f"skipped: {reason}")
sys.exit(77 if skipped else 0)
