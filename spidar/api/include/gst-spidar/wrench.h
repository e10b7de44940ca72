// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// Force, torque and pose. All are in the device's frame: right-handed, x right, y up, z towards
/// the viewer, with its origin at the centre of the workspace.
#pragma once

/// Devices, and the force of a moving picture.
namespace gst_spidar {
/// Version 0 of the binary interface, that of libgst-spidar.so.0.
inline namespace v0 {

/// Three coordinates, in the unit that the name of the variable ends in.
struct Vector3 {
  double x = 0;  ///< to the right; for a torque, about this axis, right-handed
  double y = 0;  ///< upwards
  double z = 0;  ///< towards the viewer
};

/// A rotation by an angle about an axis, as a quaternion of length 1. The default is no rotation.
struct Quaternion {
  double w = 1;  ///< cosine of half the angle
  double x = 0;  ///< x of the axis, a vector of length 1, times the sine of half the angle
  double y = 0;  ///< y of the axis times the same sine
  double z = 0;  ///< z of the axis times the same sine
};

/// Force on the grip, and torque about the grip's origin.
struct Wrench {
  Vector3 force_N;    ///< newtons
  Vector3 torque_Nm;  ///< newton metres
};

/// Where the grip is.
struct Pose {
  Vector3 position_m;      ///< the grip's origin, metres from the centre of the workspace
  Quaternion orientation;  ///< turns vectors of the grip's frame into the device's frame
};

}  // namespace v0
}  // namespace gst_spidar
