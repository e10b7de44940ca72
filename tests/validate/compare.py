#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Runs scenarios of gst-validate with spidarmotion in playbin, and with identity for comparison.

gst-validate must report the same for both, and spidarmotion must not warn. Exits with 77 (skipped)
without gst-validate-1.0; tests/README.md explains how to build it.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SCENARIOS = [
    "pause_resume", "seek_forward", "seek_backward", "seek_with_stop", "simple_seeks",
    "scrub_forward_seeking", "scrub_backward_seeking", "trick_mode_seeks", "reverse_playback",
    "fast_forward", "fast_backward", "change_state_intensive",
]
# Some issues are races in GStreamer's own queues. What spidarmotion is the cause of is always there.
TRIES = 3


def write_film(folder):
    """Half a minute of a ball with a key frame a second, as long as the scenarios ask for."""
    film = os.path.join(folder, "film.mkv")
    subprocess.run(
        ["gst-launch-1.0", "-q", "videotestsrc", "num-buffers=900", "pattern=ball", "!",
         "video/x-raw,width=320,height=240,framerate=30/1", "!", "vp8enc", "deadline=1",
         "keyframe-max-dist=30", "!", "matroskamux", "!", "filesink", f"location={film}"],
        check=True)
    return film


def judge(validate, scenario, film, video_filter):
    """Exit code and issues, each with the element on which it was seen."""
    done = subprocess.run(
        [validate, "--set-scenario", scenario, "playbin", f"uri=file://{film}",
         "audio-sink=fakesink", "video-sink=fakesink sync=true qos=true",
         f"video-filter={video_filter}"], text=True, capture_output=True, timeout=300)
    text = done.stdout + done.stderr
    issues = set(re.findall(r"^ *((?:warning|issue|critical|error) : .*\n *Detected on .*)$", text, re.M))
    assert f"{scenario}.scenario" in text, text
    return done.returncode, issues, "spidarmotion" in "".join(
        line for line in text.splitlines() if "WARN" in line)


def compare(validate, scenario, film):
    code, issues, _ = judge(validate, scenario, film, "identity")
    assert code == 0, (scenario, "identity", issues)
    more = None
    for _ in range(TRIES):
        code, with_motion, warned = judge(validate, scenario, film, "spidarmotion device=sim")
        assert code == 0 and not warned, (scenario, code, with_motion)
        more = with_motion - issues if more is None else more & (with_motion - issues)
        if not more:
            break
    print(f"{scenario}: {len(issues)} issues beside identity, {len(more)} more with spidarmotion")
    return not more


def main():
    validate = shutil.which(os.environ.get("GST_VALIDATE", "gst-validate-1.0"))
    if not validate:
        print("skipped: no gst-validate-1.0; see tests/README.md")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        film = write_film(folder)
        results = [compare(validate, scenario, film) for scenario in SCENARIOS]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
