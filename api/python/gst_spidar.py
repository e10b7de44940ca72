# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Haptic devices, and the force of a moving picture: libgst-spidar for Python.

    with gst_spidar.Device("sim") as device:
        device.push((1, 0, 0))      # newtons: to the right, up, towards the viewer; holds for 100 ms

Needs nothing but the library and Python. What the functions do in detail, and the units, are in the header
gst-spidar/c-api.h. A wrong argument raises ValueError, all else RuntimeError, with what would be right."""

import ctypes
import itertools
import threading
import time
import weakref
from ctypes import (
    POINTER,
    byref,
    c_bool,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_int64,
    c_size_t,
    c_ssize_t,
    c_uint32,
    c_void_p,
)
from enum import IntEnum


class _Struct(ctypes.Structure):
    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name, _ in self._fields_)})"


class _Numbers(_Struct):
    """Can be unpacked: x, y, z = pose.position_m."""

    def __iter__(self):
        return (getattr(self, name) for name, _ in self._fields_)


class Vector3(_Numbers):
    _fields_ = [(name, c_double) for name in "xyz"]


class Quaternion(_Numbers):
    _fields_ = [(name, c_double) for name in "wxyz"]


class Wrench(_Struct):
    _fields_ = [("force_N", Vector3), ("torque_Nm", Vector3)]


class Pose(_Struct):
    _fields_ = [("position_m", Vector3), ("orientation", Quaternion)]


class Capabilities(_Struct):
    _most = ("largest_force_N", "largest_torque_Nm", "largest_stiffness_N_m", "rate_Hz")
    _can = [(name, c_bool) for name in ("force_x", "force_y", "force_z", "torque", "direction")]
    _fields_ = [*_can, *((name, c_double) for name in _most), ("workspace_m", Vector3), ("buttons", c_int)]


class GripState(_Struct):
    _speeds = [(name, Vector3) for name in ("velocity_m_s", "angular_velocity_rad_s")]
    _fields_ = [("pose", Pose), *_speeds, ("interval_s", c_double), ("buttons", c_uint32)]


class MotionResult(_Struct):
    _speeds = [(name, c_double) for name in ("velocity_x_px_s", "velocity_y_px_s", "growth_1_s", "roll_rad_s")]
    _fields_ = [("wrench", Wrench), *_speeds, ("has_picture_before", c_bool)]


class _Error(ctypes.Structure):
    _fields_ = [("kind", c_int), ("message", c_char * 1020)]


class _Picture(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("width", c_int), ("height", c_int), ("stride", c_ssize_t)]


class _Surface(ctypes.Structure):
    _settings = ("relief_m", "stiffness_N_m", "friction", "texture")
    _fields_ = [("picture", _Picture), *((name, c_double) for name in _settings)]


State = IntEnum("State", "OPENING RUNNING IDLE LOST", start=0)
Controller = IntEnum("Controller", "LINEAR NONLINEAR ADAPTIVE", start=0)
FeltMotion = IntEnum("FeltMotion", "MEAN OBJECT CAMERA OBJECTS", start=0)

_Callback = ctypes.CFUNCTYPE(c_bool, POINTER(GripState), POINTER(Wrench), c_void_p)
_OK, _ARGUMENT, _LOST = 0, 1, 3
try:
    _library = ctypes.CDLL("libgst-spidar.so.0")
except OSError as error:
    raise ImportError(f"{error}; install libgst-spidar, or name its folder in LD_LIBRARY_PATH") from None


def _call(name, result, *arguments):
    function = getattr(_library, "gst_spidar_" + name)
    function.restype = result
    return function(*arguments)


def _checked(name, result, *arguments):
    """The same for a function whose last argument is an error, which is raised."""
    error = _Error()
    found = _call(name, result, *arguments, byref(error))
    if error.kind not in (_OK, _LOST):
        raise (ValueError if error.kind == _ARGUMENT else RuntimeError)(error.message.decode(errors="replace"))
    return found


def _text(name, handle):
    text = ctypes.create_string_buffer(1024)
    _call(name, c_size_t, handle, text, c_size_t(len(text)))
    return text.value.decode(errors="replace")


def _names(name):
    names = _checked(name, POINTER(c_char_p))
    found = list(itertools.takewhile(lambda text: text is not None, (names[i] for i in itertools.count())))
    _call("free_list", None, names)
    return [text.decode() for text in found]


def _grey(picture, width, height, stride):
    """A picture that refers to a copy of its bytes, and the copy."""
    stride = width if stride is None else stride
    view = memoryview(picture)
    needed = stride * (height - 1) + width
    if view.itemsize != 1 or view.nbytes < needed:
        raise ValueError(
            f"a picture of {width}x{height} pixels in rows of {stride} bytes needs {needed} bytes; "
            f"got {view.nbytes // view.itemsize} numbers of {view.itemsize} bytes"
        )
    pixels = (ctypes.c_uint8 * view.nbytes).from_buffer_copy(view.cast("B"))
    return _Picture(ctypes.addressof(pixels), width, height, stride), pixels


def list_devices():
    """Names for Device(): what is plugged in, then the simulated ones."""
    return _names("list_devices")


def list_profiles():
    """Names of profiles for Device()."""
    return _names("list_profiles")


_in_thread = threading.local()


def _require_no_callback():
    """What waits for the callback's end would wait for ever in it."""
    if getattr(_in_thread, "calls_back", False):
        raise RuntimeError("not within a callback; let it return no force, and do this in another thread")


class _Handle:
    """Something of the library, freed once: by close(), when nothing refers to it, or when Python ends."""

    def __init__(self, value, free):
        self._value = c_void_p(value)
        self._free = weakref.finalize(self, _call, free, None, self._value)

    def close(self):
        """Frees it; again, this does nothing."""
        _require_no_callback()
        self._free()

    @property
    def _handle(self):
        if not self._free.alive:
            raise ValueError(f"this {type(self).__name__} is closed; make another one")
        return self._value

    def _filled(self, name, struct):
        """What the function fills in; None when it says that it has not."""
        return struct if _call(name, c_bool, self._handle, byref(struct)) else None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Device(_Handle):
    """An open device: see list_devices() and list_profiles(). Closing it takes about 60 ms."""

    def __init__(self, name, profile=""):
        self._callback, self._raised = None, []
        super().__init__(_checked("device_open", c_void_p, str(name).encode(), str(profile).encode()), "device_close")

    def push(self, force_N=(0, 0, 0), torque_Nm=(0, 0, 0)):
        """The wrench from now on, for 100 ms or until the next call. False while the device takes none."""
        wrench = Wrench(Vector3(*force_N), Vector3(*torque_Nm))
        return _checked("device_push", c_bool, self._handle, byref(wrench))

    def rest(self):
        """Forgets all wrenches: the device ramps to rest."""
        _call("device_rest", None, self._handle)

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
                wrench[0] = found if isinstance(found, Wrench) else Wrench(Vector3(*found))
                return True
            except BaseException as error:  # whatever it is, nobody else would catch it
                raised.append(f"the callback has raised {type(error).__name__}: {error}")
                return False
            finally:
                _in_thread.calls_back = False

        callback = _Callback(call) if function else _Callback()
        _checked("device_set_callback", c_bool, self._handle, callback, None, 0 if passive else 1)
        self._callback, self._raised = callback, raised  # kept while it may be called

    def callback_error(self):
        """Why the callback is not called any more; empty while it is."""
        error = _text("device_callback_error", self._handle)
        return self._raised[0] if error and self._raised else error

    def set_limits(self, max_force_N, max_torque_Nm):
        """Of the total force and torque of whatever is pushed."""
        _checked("device_set_limits", c_bool, self._handle, c_double(max_force_N), c_double(max_torque_Nm))

    def set_surface(
        self, picture, width, height, stride=None, *, relief_m=0.008, stiffness_N_m=200, friction=0.3, texture=0
    ):
        """Lets the grip touch a relief, 255 nearest, until another one or clear_surface(). False while the device is
        lost. The picture is as for MotionToWrench.analyze()."""
        grey, _pixels = _grey(picture, width, height, stride)
        surface = _Surface(grey, relief_m, stiffness_N_m, friction, texture)
        return _checked("device_set_surface", c_bool, self._handle, byref(surface))

    def clear_surface(self):
        """Nothing is touched any more."""
        _call("device_clear_surface", None, self._handle)

    def pose(self):
        """Where the grip is; None while that is not known."""
        return self._filled("device_pose", Pose())

    def velocity(self):
        """In m/s, about 3 ms ago; None while the pose is not known."""
        return self._filled("device_velocity", Vector3())

    def buttons(self):
        """Those that are pressed: the lowest bit is the first button."""
        return _call("device_buttons", c_uint32, self._handle)

    def held(self):
        """False when the force rests because nobody seems to hold the grip."""
        return _call("device_held", c_bool, self._handle)

    def vibration_share(self):
        """Share of the wanted wrench that may be exerted."""
        return _call("device_vibration_share", c_double, self._handle)

    def felt(self):
        """The Wrench that the device is told to exert at present."""
        wrench = Wrench()
        _call("device_felt", None, self._handle, byref(wrench))
        return wrench

    def state(self):
        """What the device is doing."""
        return State(_call("device_state", c_int, self._handle))

    def wait_until_running(self, timeout_s):
        """Until the pose is known; False when the time is over."""
        until_s = time.monotonic() + timeout_s
        # In short pieces, so that Ctrl+C ends it.
        while not _call("device_wait_until_running", c_bool, self._handle, c_int64(50)):
            if time.monotonic() > until_s:
                return False
        return True

    def last_fault(self):
        """Of the link to the device; empty when there was none."""
        return _text("device_last_fault", self._handle)

    def capabilities(self):
        """What the device can do."""
        found = Capabilities()
        _call("device_capabilities", None, self._handle, byref(found))
        return found

    def name(self):
        """What was opened."""
        return _call("device_name", c_char_p, self._handle).decode()


class MotionToWrench(_Handle):
    """Measures the motion of grey pictures and says what is to be felt of it."""

    def __init__(self):
        super().__init__(_checked("motion_new", c_void_p), "motion_free")

    def analyze(self, picture, width, height, time_s, stride=None):
        """The next picture: bytes, or what has them in one piece, such as an array of NumPy. Returns a MotionResult."""
        grey, _pixels = _grey(picture, width, height, stride)
        result = MotionResult()
        time_ns = c_int64(round(1e9 * time_s))
        _checked("motion_analyze", c_bool, self._handle, byref(grey), time_ns, byref(result))
        return result

    def restart(self):
        """The next picture has nothing to do with the one before."""
        _call("motion_restart", None, self._handle)

    def set_controller(self, controller):
        """How speed becomes force, a Controller."""
        _checked("motion_set_controller", c_bool, self._handle, c_int(controller))

    def set_motion(self, motion):
        """Which motion is felt, a FeltMotion."""
        _checked("motion_set_motion", c_bool, self._handle, c_int(motion))

    def set_max_force(self, max_force_N):
        """The largest force."""
        _checked("motion_set_max_force", c_bool, self._handle, c_double(max_force_N))

    def set_pointer(self, x, y):
        """Where FeltMotion.OBJECTS is felt most: (0, 0) is the top left corner of the picture, (1, 1) the other one."""
        _checked("motion_set_pointer", c_bool, self._handle, c_double(x), c_double(y))

    def set_gains(self, depth, roll):
        """How strongly growth and roll are felt, 1 at first."""
        _checked("motion_set_gains", c_bool, self._handle, c_double(depth), c_double(roll))

    def set_alpha(self, alpha_s_px):
        """How quickly force rises with speed, 0.01 at first."""
        _checked("motion_set_alpha", c_bool, self._handle, c_double(alpha_s_px))
