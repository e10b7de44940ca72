#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""The module gst_spidar, used as by other programs, and the examples in Python.

check_python.py EXAMPLES    EXAMPLES is the folder; PYTHONPATH and LD_LIBRARY_PATH name module and library"""

import array
import gc
import math
import os
import re
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

import gst_spidar
from gst_spidar import Device, FeltMotion, MotionToWrench, State

EXAMPLES = Path(sys.argv.pop(1))
SPOTS = bytes((x // 4 * 73 + y // 4 * 151) * 2654435761 % 2**32 >> 24 for y in range(240) for x in range(240))


def run(*command):
    return subprocess.run(
        [sys.executable, *map(str, command)], capture_output=True, text=True, timeout=100, stdin=subprocess.DEVNULL
    )


def comes_true(what):
    """Events take milliseconds; the limit is generous for a busy machine."""
    end = time.monotonic() + 60
    while not what():
        if time.monotonic() > end:
            return False
        time.sleep(0.001)
    return True


class Devices(unittest.TestCase):
    def test_a_push_is_felt_until_rest(self):
        with Device("sim") as device:
            self.assertEqual(device.name(), "sim")
            self.assertTrue(comes_true(lambda: device.push((0.5, 0.25, 0)) and device.felt().force_N.x > 0.4))
            self.assertTrue(0.1 < device.felt().force_N.y < 0.4)
            device.rest()
            self.assertTrue(comes_true(lambda: abs(device.felt().force_N.x) < 0.01))

    def test_it_tells_what_it_does(self):
        with Device("sim", "spidar-g") as device:
            self.assertTrue(device.wait_until_running(60))
            self.assertEqual(device.state(), State.RUNNING)
            x, y, z = device.pose().position_m
            self.assertLess(math.hypot(x, y, z), 0.005)  # the simulated hand is soft
            self.assertAlmostEqual(device.pose().orientation.w, 1, delta=0.01)
            self.assertLess(abs(device.velocity().x), 0.5)
            self.assertTrue(device.held())
            self.assertEqual(device.vibration_fraction(), 1)
            self.assertEqual(device.last_fault(), "")
            self.assertEqual(device.warning(), "")
            self.assertTrue(device.capabilities().force_z)
            self.assertEqual(device.capabilities().rate_Hz, 1000)
            self.assertTrue(all(0.02 < size_m < 1 for size_m in device.capabilities().workspace_m))
            self.assertEqual(device.capabilities().buttons, 0)
            self.assertIn("position_m=Vector3(x=", repr(device.pose()))

    def test_a_callback_is_felt(self):
        seen = []

        def push(grip):
            seen.append(grip)
            return 1, 0, 0

        with Device("sim") as device:
            device.set_callback(push, passive=False)
            self.assertTrue(comes_true(lambda: device.felt().force_N.x > 0.9 or device.callback_error()))
            # The grip is a copy: what is kept does not change. A busy machine may find Python too slow.
            self.assertTrue(seen and all(0.99 < grip.pose.orientation.w < 1.01 for grip in seen))
            device.set_callback(None)
            self.assertEqual(device.callback_error(), "")
            calls = len(seen)
            time.sleep(0.02)
            self.assertEqual(len(seen), calls)

    def test_a_callback_that_raises_ends_alone(self):
        def divide(grip):
            return 1 / 0, 0, 0

        def leave(grip):
            sys.exit("left")

        with Device("sim") as device:
            for callback, error in ((divide, "ZeroDivisionError: division by zero"), (leave, "SystemExit: left")):
                device.set_callback(callback)
                self.assertTrue(comes_true(device.callback_error))
                self.assertEqual(device.callback_error(), "the callback has raised " + error)
            for wrong in (None, 1, (1, 2, 3, 4), ("a", 0, 0)):
                device.set_callback(lambda grip, wrong=wrong: wrong)
                self.assertTrue(comes_true(device.callback_error))
                self.assertRegex(device.callback_error(), "the callback has raised (TypeError|ValueError)")
            self.assertTrue(comes_true(lambda: device.push((1, 0, 0)) and device.felt().force_N.x > 0.9))

    def test_a_surface_is_touched(self):
        with Device("sim") as device:
            self.assertTrue(device.wait_until_running(60))
            self.assertTrue(device.set_surface(b"\xff" * 256, 16, 16))
            # 4 mm in front of the hand: 200 N/m against its 300 N/m give 0.48 N.
            self.assertTrue(comes_true(lambda: device.felt().force_N.z > 0.3))
            device.clear_surface()
            self.assertTrue(comes_true(lambda: abs(device.felt().force_N.z) < 0.05))
            with self.assertRaisesRegex(ValueError, "at most 800 N/m on this device, got 900"):
                device.set_surface(b"\xff" * 256, 16, 16, stiffness_N_m=900)
            with self.assertRaisesRegex(ValueError, "needs 272 bytes; got 256"):
                device.set_surface(b"\xff" * 256, 16, 17)

    def test_a_callback_cannot_wait_for_itself(self):
        with Device("sim") as device:
            for waits in (
                device.close,
                lambda: device.set_callback(None),
                lambda: device.push((0, 0, 0)),
                lambda: device.set_limits(1, 0.1),
                lambda: device.set_surface(b"\xff" * 256, 16, 16),
                lambda: device.wait_until_running(3600),
            ):
                device.set_callback(lambda grip, waits=waits: waits())
                self.assertTrue(comes_true(device.callback_error))
                self.assertIn("RuntimeError: not within a callback", device.callback_error())
            self.assertRaisesRegex(TypeError, "function of a GripState", device.set_callback, 3)

    def test_what_is_wrong_is_named(self):
        with self.assertRaisesRegex(RuntimeError, 'unknown device "nosuch"; known are'):
            Device("nosuch")
        with self.assertRaisesRegex(RuntimeError, 'unknown profile "nosuch"'):
            Device("sim", "nosuch")
        with Device("sim") as device:
            with self.assertRaisesRegex(ValueError, "0 to 7.2 N"):
                device.set_limits(1e9, 0.1)
            with self.assertRaisesRegex(ValueError, "six finite numbers"):
                device.push((math.nan, 0, 0))
            with self.assertRaises(TypeError):
                device.push(("1", 0, 0))
            for wrong in ((1, 0), (1, 0, 0, 0)):
                said = f"is three numbers \\(x, y, z\\); got {len(wrong)}"
                self.assertRaisesRegex(ValueError, f"force_N {said}", device.push, wrong)
                self.assertRaisesRegex(ValueError, f"torque_Nm {said}", device.push, (1, 0, 0), wrong)
            device.set_callback(lambda grip: (1, 0))
            self.assertTrue(comes_true(device.callback_error))
            self.assertIn("the force is three numbers (x, y, z); got 2", device.callback_error())
        with self.assertRaisesRegex(ValueError, "it is closed; make another one"):
            device.push((1, 0, 0))
        device.close()  # again

    def test_a_name_that_c_would_cut_is_refused(self):
        for names in (("sim\0x",), ("sim", "spidar-g\0.toml")):
            with self.assertRaisesRegex(ValueError, "has a NUL in it"):
                Device(*names)

    def test_a_forked_process_is_told_that_it_has_no_device(self):
        with Device("sim") as device:
            self.assertTrue(device.wait_until_running(60))
            child = os.fork()
            if child == 0:
                try:
                    device.push((1, 0, 0))
                except RuntimeError as error:
                    is_told = "fork" in str(error) and device.state() == State.LOST
                    device.close()  # and does not wait for a thread that it has not
                    os._exit(0 if is_told else 1)
                os._exit(2)
            self.assertEqual(os.waitpid(child, 0)[1], 0)
            self.assertTrue(device.push((1, 0, 0)), "the parent has it still")

    def test_it_closes_when_nothing_refers_to_it(self):
        def threads():
            return len(list(Path("/proc/self/task").iterdir()))

        before = threads()
        device = Device("sim")
        device.set_callback(lambda grip: (0, 0, device.felt().force_N.z))  # a circle
        self.assertGreater(threads(), before)
        del device
        gc.collect()
        self.assertEqual(threads(), before)

    def test_python_ends_while_a_callback_runs(self):
        program = """
import gst_spidar, threading
called = threading.Event()
device = gst_spidar.Device("sim")
device.set_callback(lambda grip: called.set() or (0, 0, 0))
called.wait(60)
"""
        for end, status in (("", 0), ("raise SystemExit(3)", 3), ("1 / 0", 1)):
            with self.subTest(end):
                done = run("-c", program + end)
                self.assertEqual(done.returncode, status, done.stderr)
                self.assertNotIn("Fatal", done.stderr)

    def test_a_budget_of_vibration_that_cannot_be_kept_is_a_warning(self):
        program = "import gst_spidar\nwith gst_spidar.Device('sim') as device: print(device.warning())"
        for state, said in (("", "\n"), ("/proc/none", "Half of what is allowed in a day counts as used.\n")):
            with self.subTest(state):
                done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=100,
                                      check=True, env={**os.environ, "SPIDAR_STATE": state})
                self.assertTrue(done.stdout.endswith(said), done.stdout)

    def test_threads_fraction_a_device_until_one_closes_it(self):
        device = Device("sim")
        ends = []

        def use(call):
            try:
                while True:
                    call()
            except ValueError as error:
                ends.append(str(error))

        calls = (device.felt, lambda: device.push((1, 0, 0)), lambda: device.wait_until_running(1), device.pose)
        threads = [threading.Thread(target=use, args=(call,)) for call in calls]
        for thread in threads:
            thread.start()
        self.assertTrue(comes_true(lambda: device.felt().force_N.x > 0.5))
        device.close()
        for thread in threads:
            thread.join()
        self.assertEqual(ends, ["it is closed; make another one"] * 4)


class Pictures(unittest.TestCase):
    def test_a_moving_picture_pushes(self):
        motion = MotionToWrench()
        motion.configure(motion=FeltMotion.MEAN)
        motion.configure(max_force_N=1.5)
        for i in range(10):
            # Turned by 4 i pixels in each row, as bytes and as an array.
            rows = [SPOTS[240 * y : 240 * (y + 1)] for y in range(240)]
            turned = b"".join(row[-4 * i :] + row[: -4 * i] if i else row for row in rows)
            found = motion.analyze(turned if i % 2 else array.array("B", turned), 240, 240, 0.04 * i)
        self.assertTrue(found.has_picture_before)
        # As in test_c_api.c; what enters on the left is another part of the texture.
        self.assertAlmostEqual(found.velocity_x_px_s, 100, delta=0.03 / 0.04)
        self.assertAlmostEqual(found.wrench.force_N.x, 3 / math.pi * math.atan(0.0025 * 200), delta=0.015)
        motion.reset()
        self.assertFalse(motion.analyze(SPOTS, 240, 240, 1).has_picture_before)

    def test_what_is_wrong_is_named(self):
        motion = MotionToWrench()
        for picture, width, height, stride, message in (
            (SPOTS, 240, 241, None, "needs 57840 bytes; got 57600"),
            (SPOTS, 240, 240, 241, "needs 57839 bytes; got 57600"),
            (SPOTS, 240, 240, 239, "stride 239"),
            (SPOTS, 8, 8, None, "at least 16x16 pixels"),
            (SPOTS, 240, 0, None, "at least 16x16 pixels"),
            (SPOTS, -240, 240, None, "at least 16x16 pixels"),
            (array.array("d", SPOTS), 240, 240, None, "numbers of 8 bytes"),
            (SPOTS, 2**32 + 240, 1, None, "needs"),
        ):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                motion.analyze(picture, width, height, 0, stride)
        for name, wrong in (("motion", 9), ("controller", 9), ("max_force_N", -1), ("pointer_x", math.nan),
                            ("roll_gain", -1), ("alpha_s_px", -1)):
            with self.subTest(name), self.assertRaises(ValueError):
                motion.configure(**{name: wrong})
        with self.assertRaisesRegex(TypeError, "no setting force"):
            motion.configure(force=1)


class Examples(unittest.TestCase):
    def said(self, name, *arguments):
        path = EXAMPLES / f"{name}.py"
        self.assertLessEqual(len(path.read_text(encoding="utf-8").splitlines()), 40)
        done = run(path, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_push(self):
        strongest = float(re.search(r"sim: ([\d.]+) N", self.said("push")).group(1))
        self.assertTrue(0.5 < strongest <= 2)  # 1 N is asked for, in every direction

    def test_spring(self):
        said = self.said("spring")
        place_mm, force_N = map(float, re.findall(r"-?[\d.]+(?= mm| N)", said))
        # 1 N against the simulated hand, 300 N/m, and the spring, 200 N/m: 2 mm; without the spring 3.3 mm. A busy
        # machine may find Python too slow.
        self.assertTrue(1.3 < place_mm < 2.7 and 0.4 < force_N < 0.8 or "longer than" in said, said)

    def test_motion(self):
        speed, force = map(float, re.findall(r"[\d.]+(?= px/s| N)", self.said("motion").splitlines()[-1]))
        # 4 px in 40 ms are 100 px/s; the first pictures do not know yet what is background.
        self.assertTrue(95 < speed < 105 and force > 0.8)

    def test_a_device_that_does_not_exist(self):
        for name in ("push", "spring"):
            done = run(EXAMPLES / f"{name}.py", "nosuch")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn('unknown device "nosuch"', done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
