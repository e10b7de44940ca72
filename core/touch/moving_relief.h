// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A relief interpolated between two frames.
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "core/touch/height_field.h"

namespace spidar {

/// Interpolates between two reliefs with share s and displacement u: h(p) = (1 − s) before(p − s u)
/// + s after(p + (1 − s) u). An object that moves by u from one frame to the next keeps its shape;
/// plain cross-fading would show it twice. Does not own the fields.
struct MovingRelief {
  const HeightField* before = nullptr;  ///< must not be null
  const HeightField* after = nullptr;   ///< null: only `before`, which is static
  double share = 0;                     ///< of `after`, 0 … 1
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();

  SurfacePoint at(const Eigen::Vector2d& place_m) const noexcept {
    if (after == nullptr) return before->at(place_m.x(), place_m.y());
    const Eigen::Vector2d p = place_m - share * displacement_m;
    const Eigen::Vector2d q = place_m + (1 - share) * displacement_m;
    const SurfacePoint a = before->at(p.x(), p.y());
    const SurfacePoint b = after->at(q.x(), q.y());
    return {a.z_m + share * (b.z_m - a.z_m), a.slope + share * (b.slope - a.slope)};
  }

  double cell_m() const noexcept { return std::min(before->cell_x_m(), before->cell_y_m()); }
};

}  // namespace spidar
