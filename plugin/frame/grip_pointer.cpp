// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/grip_pointer.h"

#include <algorithm>

namespace spidar {
namespace {

constexpr double kReach = 0.5;  // of the frame

/// Maps −half … half to 0 … 1.
double share(double at_m, double half_m) {
  if (!(half_m > 0)) return 0.5;
  return std::min(std::max(0.5 + at_m / (2 * half_m), 0.0), 1.0);
}

}  // namespace

GripPointer::GripPointer(const StringGeometry& geometry) {
  for (int i = 0; i < geometry.count; ++i) {
    const Eigen::Vector3d& exit_m = geometry.exit_m[static_cast<size_t>(i)];
    half_size_m_ = half_size_m_.cwiseMax(kReach * exit_m.head<2>().cwiseAbs());
  }
}

Eigen::Vector2d GripPointer::place(const Eigen::Vector3d& position_m) const {
  return {share(position_m.x(), half_size_m_.x()), share(-position_m.y(), half_size_m_.y())};
}

}  // namespace spidar
