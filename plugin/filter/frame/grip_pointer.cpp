// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/frame/grip_pointer.h"

#include <algorithm>

#include "core/grip/picture_size.h"

namespace spidar {
namespace {

/// Maps −half … half to 0 … 1.
double share(double at_m, double half_m) {
  if (!(half_m > 0)) return 0.5;
  return std::min(std::max(0.5 + at_m / (2 * half_m), 0.0), 1.0);
}

}  // namespace

GripPointer::GripPointer(const StringGeometry& geometry) : half_size_m_(half_picture_m(geometry)) {}

Eigen::Vector2d GripPointer::place(const Eigen::Vector3d& position_m) const {
  return {share(position_m.x(), half_size_m_.x()), share(-position_m.y(), half_size_m_.y())};
}

}  // namespace spidar
