#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Opens a device and pushes its grip in a circle for a second:
  push.py [DEVICE]     sim, the simulated SPIDAR, when none is named
Needs nothing but the module gst_spidar, which comes with libgst-spidar."""

import math
import signal
import sys
import time

import gst_spidar

signal.signal(signal.SIGINT, lambda *_: sys.exit(130))  # Ctrl+C: the device comes to rest
with gst_spidar.Device(sys.argv[1] if len(sys.argv) > 1 else "sim") as device:
    device.set_limits(2.0, 0.05)
    strongest_N = 0
    for step in range(100):
        angle = 2 * math.pi * step / 100
        if not device.push((math.cos(angle), math.sin(angle), 0)):
            print(f"the device is lost: {device.last_fault()}", file=sys.stderr)
        time.sleep(0.01)
        strongest_N = max(strongest_N, math.hypot(*device.felt().force_N))
    print(f"{device.name()}: {strongest_N:.2f} N at most")
