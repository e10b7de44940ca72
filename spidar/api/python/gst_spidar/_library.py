# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""libgst-spidar as ctypes sees it: the types of gst-spidar/c-api.h, its functions, and what is to be freed."""

import ctypes
import itertools
import threading
import weakref
from ctypes import POINTER, byref, c_bool, c_char, c_char_p, c_double
from ctypes import c_int, c_size_t, c_ssize_t, c_uint32, c_void_p
from enum import IntEnum


class _Struct(ctypes.Structure):
    """Can be unpacked: x, y, z = pose.position_m."""

    def __iter__(self):
        return (getattr(self, name) for name, _ in self._fields_)

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name, _ in self._fields_)})"


class Vector3(_Struct):
    _fields_ = [(name, c_double) for name in "xyz"]


def _vector(numbers, name):
    """Vector3() alone would take fewer than three, and make the others zero."""
    numbers = tuple(numbers)
    if len(numbers) != 3:
        raise ValueError(f"{name} is three numbers (x, y, z); got {len(numbers)}: {numbers!r}")
    return Vector3(*numbers)


class Quaternion(_Struct):
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


class MotionSettings(_Struct):
    _numbers = ("max_force_N", "alpha_s_px", "pointer_x", "pointer_y", "depth_gain", "roll_gain")
    _fields_ = [("controller", c_int), ("motion", c_int), *((name, c_double) for name in _numbers)]


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


def _text(text, what):
    """As C takes it, which would take what is before a NUL for the whole."""
    encoded = str(text).encode()
    if b"\0" in encoded:
        raise ValueError(f"{what} has a NUL in it: {text!r}")
    return encoded


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


_in_thread = threading.local()


def _require_no_callback():
    """What waits for the callback's end would wait for ever in it."""
    if getattr(_in_thread, "calls_back", False):
        raise RuntimeError("not within a callback; let it return no force, and do this in another thread")


class _Use:
    """Of something of the library, by any threads, until it is freed."""

    def __init__(self, value, free):
        self.value, self.free = c_void_p(value), free
        self.calls, self.closed, self.changed = 0, False, threading.Condition()

    def __call__(self, call, name, result, *arguments):
        with self.changed:
            if self.closed:
                raise ValueError("it is closed; make another one")
            self.calls += 1
        try:
            return call(name, result, self.value, *arguments)
        finally:
            with self.changed:
                self.calls -= 1
                self.changed.notify_all()

    def close(self):
        with self.changed:
            self.closed = True
            self.changed.wait_for(lambda: self.calls == 0)
        _call(self.free, None, self.value)


class _Handle:
    """Something of the library, freed once: by close(), when nothing refers to it, or when Python ends."""

    def __init__(self, value, free):
        self._use = _Use(value, free)
        self._close = weakref.finalize(self, self._use.close)

    def close(self):
        """Frees it once no other thread uses it; again, this does nothing."""
        _require_no_callback()
        self._close()

    def _call(self, *arguments):
        return self._use(_call, *arguments)

    def _checked(self, *arguments):
        return self._use(_checked, *arguments)

    def _text(self, name):
        text = ctypes.create_string_buffer(1024)
        self._call(name, c_size_t, text, c_size_t(len(text)))
        return text.value.decode(errors="replace")

    def _filled(self, name, struct):
        """What the function fills in; None when it says that it has not."""
        return struct if self._call(name, c_bool, byref(struct)) else None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
