// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Conversions between the types of the installed headers and those of the rest of the project.
#pragma once

#include <gst-spidar/picture.h>
#include <gst-spidar/wrench.h>

#include "core/grip/string_geometry.h"
#include "core/picture/image_view.h"
#include "core/wrench.h"

namespace gst_spidar {
inline namespace v0 {

inline Vector3 to_api(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d from_api(const Vector3& v) {
  return {v.x, v.y, v.z};
}
inline Wrench to_api(const spidar::Wrench& wrench) {
  return {to_api(wrench.force_N), to_api(wrench.torque_Nm)};
}
inline spidar::Wrench from_api(const Wrench& wrench) {
  return {from_api(wrench.force_N), from_api(wrench.torque_Nm)};
}
inline spidar::ImageView from_api(const GreyPicture& picture) {
  return {picture.data, picture.width, picture.height, picture.stride};
}
inline Pose to_api(const spidar::Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {to_api(pose.position_m), {q.w(), q.x(), q.y(), q.z()}};
}

}  // namespace v0
}  // namespace gst_spidar
