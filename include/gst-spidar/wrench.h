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

/// Three coordinates.
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A turn, as a quaternion of length 1.
struct Quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Force on the grip, and torque about the grip's origin.
struct Wrench {
  Vector3 force_N;    ///< newtons
  Vector3 torque_Nm;  ///< newton metres
};

/// Where the grip is.
struct Pose {
  Vector3 position_m;      ///< of the grip's origin, metres from the centre of the workspace
  Quaternion orientation;  ///< turns vectors of the grip's frame into the device's frame
};

}  // namespace v0
}  // namespace gst_spidar
