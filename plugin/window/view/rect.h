// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A rectangle in pixels, or in fractions of a picture.
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace spidar::window {

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
  /// False for a position that is not finite.
  bool has(const Eigen::Vector2d& at) const {
    return at.x() >= x && at.x() < right() && at.y() >= y && at.y() < bottom();
  }
  /// The rectangle this far inside on all sides, whose size is never negative.
  Rect inset(double margin) const {
    const double dx = std::min(margin, width / 2), dy = std::min(margin, height / 2);
    return {x + dx, y + dy, width - 2 * dx, height - 2 * dy};
  }
};

}  // namespace spidar::window
