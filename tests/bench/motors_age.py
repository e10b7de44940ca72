#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""How old the force is when examples/motors.py sends it, and how soon it rests after SIGTERM: motors_age.py [SECONDS]

On an idle machine, the median is to be less than 5 ms, and 99 % less than 15 ms.
"""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples"))

import motors  # noqa: E402

ages_ms, times_s = [], []


class Trace(motors.Trace):
    def newest(self):
        row = super().newest()
        if row:
            ages_ms.append((time.monotonic_ns() - int(row["monotonic_ns"])) / 1e6)
        return row


class Osc(motors.Osc):
    def rest(self):
        super().rest()
        times_s.append(time.monotonic())


def end():
    times_s.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGTERM)


def main():
    length_s = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    motors.Trace, motors.KINDS["osc"] = Trace, Osc
    with tempfile.TemporaryDirectory() as folder:
        film = os.path.join(folder, "ball.avi")
        subprocess.run(["gst-launch-1.0", "-q", "videotestsrc", "pattern=ball", f"num-buffers={25 * length_s + 50}", "!",
                        "video/x-raw,width=320,height=240,framerate=25/1", "!", "jpegenc", "!", "avimux", "!", "filesink",
                        f"location={film}"], check=True)
        for rate in 100, 1000:
            ages_ms.clear()
            times_s.clear()
            sys.argv[1:] = [film, "osc:127.0.0.1:9", "--headless", "--rate", str(rate)]
            threading.Timer(length_s, end).start()
            try:
                motors.main()
            except SystemExit as ended:
                assert not ended.code, ended.code
            ages_ms.sort()
            print(f"{rate} Hz: {len(ages_ms) / length_s:.0f} rows a second, {ages_ms[len(ages_ms) // 2]:.1f} ms old at the "
                  f"median, {ages_ms[len(ages_ms) * 99 // 100]:.1f} ms at 99 %; at rest "
                  f"{1e3 * (times_s[1] - times_s[0]):.1f} ms after SIGTERM")


if __name__ == "__main__":
    main()
