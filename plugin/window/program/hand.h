// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A hand that holds the grip, as a drawing in space.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace spidar {

/// A stroke with round ends along a line of points.
struct HandStroke {
  std::vector<Eigen::Vector3d> points;  ///< in units of the grip's radius, in its frame G
  double width = 0;                     ///< in the same units
  bool in_front = true;                 ///< of the grip, as the viewer sees it
};

/// A right hand whose fingers lie around a ball of radius 1, strokes from back to front.
const std::vector<HandStroke>& hand_strokes();

}  // namespace spidar
