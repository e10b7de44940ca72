# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Haptic devices, and the force of a moving picture: libgst-spidar for Python.

    with gst_spidar.Device("sim") as device:
        device.push((1, 0, 0))      # newtons: to the right, up, towards the viewer; holds for 100 ms

Needs nothing but the library and Python. What the functions do in detail, and the units, are in the header
gst-spidar/c-api.h. A wrong number or shape raises ValueError, a wrong type TypeError, all else, as an unknown device,
RuntimeError, with what would be right."""

import threading
import time
from ctypes import byref, c_bool, c_char_p, c_double, c_int, c_int64, c_uint32, c_void_p

from gst_spidar._library import Capabilities, Controller, FeltMotion, GripState, MotionResult, MotionSettings, Pose
from gst_spidar._library import Quaternion, State, Vector3, Wrench
from gst_spidar._library import _call, _Callback, _checked, _grey, _Handle, _in_thread, _names, _require_no_callback, _Surface
from gst_spidar._library import _text, _vector

# A list that editors and type checkers read.
__all__ = ["Capabilities", "Controller", "Device", "FeltMotion", "GripState", "MotionResult", "MotionSettings",
           "MotionToWrench", "Pose", "Quaternion", "State", "Vector3", "Wrench", "list_devices", "list_profiles"]


def list_devices():
    """Names for Device(): what is plugged in, then the simulated ones."""
    return _names("list_devices")


def list_profiles():
    """Names of profiles for Device()."""
    return _names("list_profiles")


class Device(_Handle):
    """An open device: see list_devices() and list_profiles(). Closing it takes about 60 ms. Any threads may use it;
    calls that change something run one after another, and those that might wait raise RuntimeError within a callback."""

    def __init__(self, name, profile=""):
        self._callback, self._raised, self._setting = None, [], threading.Lock()
        names = _text(name, "the name of a device"), _text(profile, "the name of a profile")
        super().__init__(_checked("device_open", c_void_p, *names), "device_close")

    def push(self, force_N=(0, 0, 0), torque_Nm=(0, 0, 0)):
        """The wrench from now on, for 100 ms or until the next call. False while the device takes none."""
        wrench = Wrench(_vector(force_N, "force_N"), _vector(torque_Nm, "torque_Nm"))
        return self._checked("device_push", c_bool, byref(wrench))

    def rest(self):
        """Forgets all wrenches: the device ramps to rest."""
        self._call("device_rest", None)

    def set_callback(self, function, passive=True):
        """Calls function(GripState) each millisecond and adds the force that it returns, three newtons, or a Wrench,
        to what is pushed; None ends this. Passive, it gives the hand no more energy than the hand has put in, and no
        torque. One that raises, or is late, is not called again: see callback_error()."""
        _require_no_callback()
        if function is not None and not callable(function):
            raise TypeError(f"a callback is a function of a GripState, or None; got {function!r}")
        raised = []

        def call(grip, wrench, _):
            _in_thread.calls_back = True
            try:
                found = function(GripState.from_buffer_copy(grip[0]))
                wrench[0] = found if isinstance(found, Wrench) else Wrench(_vector(found, "the force"))
                return True
            except BaseException as error:  # whatever it is, nobody else would catch it
                raised.append(f"the callback has raised {type(error).__name__}: {error}")
                return False
            finally:
                _in_thread.calls_back = False

        callback = _Callback(call) if function else _Callback()
        with self._setting:
            self._checked("device_set_callback", c_bool, callback, None, 0 if passive else 1)
            self._callback, self._raised = callback, raised  # kept while it may be called

    def callback_error(self):
        """Why the callback is not called any more; empty while it is."""
        error = self._text("device_callback_error")
        return self._raised[0] if error and self._raised else error

    def set_limits(self, max_force_N, max_torque_Nm):
        """Of the total force and torque of whatever is pushed."""
        self._checked("device_set_limits", c_bool, c_double(max_force_N), c_double(max_torque_Nm))

    def set_surface(
        self, picture, width, height, stride=None, *, relief_m=0.008, stiffness_N_m=200, friction=0.3, texture=0
    ):
        """Lets the grip touch a relief, 255 nearest, until another one or clear_surface(). False while the device is
        lost. The picture is as for MotionToWrench.analyze()."""
        grey, _pixels = _grey(picture, width, height, stride)
        surface = _Surface(grey, relief_m, stiffness_N_m, friction, texture)
        return self._checked("device_set_surface", c_bool, byref(surface))

    def clear_surface(self):
        """Nothing is touched any more."""
        self._call("device_clear_surface", None)

    def pose(self):
        """Where the grip is; None while that is not known."""
        return self._filled("device_pose", Pose())

    def velocity(self):
        """In m/s, about 3 ms ago; None while the pose is not known."""
        return self._filled("device_velocity", Vector3())

    def buttons(self):
        """Those that are pressed: the lowest bit is the first button."""
        return self._call("device_buttons", c_uint32)

    def held(self):
        """False while the force rests or returns because nobody seems to hold the grip."""
        return self._call("device_held", c_bool)

    def vibration_fraction(self):
        """Share of the wanted wrench that may be exerted."""
        return self._call("device_vibration_fraction", c_double)

    def felt(self):
        """The Wrench that is commanded at present."""
        wrench = Wrench()
        self._call("device_felt", None, byref(wrench))
        return wrench

    def state(self):
        """What the device is doing."""
        return State(self._call("device_state", c_int))

    def wait_until_running(self, timeout_s):
        """Until the pose is known; False when the time is over."""
        _require_no_callback()
        until_s = time.monotonic() + timeout_s
        # In short pieces, so that Ctrl+C ends it.
        while not self._call("device_wait_until_running", c_bool, c_int64(50)):
            if time.monotonic() > until_s:
                return False
        return True

    def last_fault(self):
        """Of the link to the device; empty when there was none."""
        return self._text("device_last_fault")

    def warning(self):
        """What is not as it should be although the device works; empty if all is well."""
        return self._text("device_warning")

    def capabilities(self):
        """What the device can do."""
        found = Capabilities()
        self._call("device_capabilities", None, byref(found))
        return found

    def name(self):
        """What was opened."""
        return self._call("device_name", c_char_p).decode()


class MotionToWrench(_Handle):
    """Measures the motion of grey pictures and says what is to be felt of it."""

    def __init__(self):
        super().__init__(_checked("motion_new", c_void_p), "motion_free")
        self._settings = MotionSettings()
        _call("motion_settings_init", None, byref(self._settings))

    def analyze(self, picture, width, height, time_s, stride=None):
        """The next picture: bytes, or what has them in one piece, such as an array of NumPy. Returns a MotionResult."""
        grey, _pixels = _grey(picture, width, height, stride)
        result = MotionResult()
        time_ns = c_int64(round(1e9 * time_s))
        self._checked("motion_analyze", c_bool, byref(grey), time_ns, byref(result))
        return result

    def reset(self):
        """The next picture has nothing to do with the one before."""
        self._call("motion_reset", None)

    def configure(self, **settings):
        """From the next picture on, and the others as before: controller, a Controller; motion, a FeltMotion;
        max_force_N, alpha_s_px, pointer_x and pointer_y, depth_gain and roll_gain, as in GstSpidarMotionSettings."""
        wanted = MotionSettings.from_buffer_copy(self._settings)
        for name, value in settings.items():
            if name not in dict(MotionSettings._fields_):
                raise TypeError(f"there is no setting {name}; {', '.join(dict(MotionSettings._fields_))} are")
            setattr(wanted, name, value)
        self._checked("motion_configure", c_bool, byref(wanted))
        self._settings = wanted
