#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A spring towards the centre, for two seconds; prints how far the grip was from there, and what was felt then:
  spring.py [DEVICE]     sim, the simulated SPIDAR, which is pushed to the right
The spring is found in the thread that drives the device, a thousand times a second. The library keeps it passive:
a hand gets no more energy from it than it has put in."""

import signal
import sys
import time

import gst_spidar

STIFFNESS_N_m = 200


def spring(grip):
    x, y, z = grip.pose.position_m
    return -STIFFNESS_N_m * x, -STIFFNESS_N_m * y, -STIFFNESS_N_m * z


signal.signal(signal.SIGINT, lambda *_: sys.exit(130))  # Ctrl+C: the device comes to rest
with gst_spidar.Device(sys.argv[1] if len(sys.argv) > 1 else "sim") as device:
    if not device.wait_until_running(30):
        sys.exit(f"no pose: {device.last_fault() or 'the readings of the device do not agree'}")
    sys.setswitchinterval(1e-4)  # the thread of the device waits for this one no longer
    device.set_callback(spring)
    for _ in range(100):
        if len(sys.argv) < 2:
            device.push((1, 0, 0))  # nobody else pushes the simulated hand
        time.sleep(0.02)
    position_mm = 1000 * device.pose().position_m.x
    print(f"{position_mm:.1f} mm to the right, {device.felt().force_N.x:.2f} N {device.callback_error()}")
