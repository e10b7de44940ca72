// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boxes that somebody else found in a picture: a detector or a tracker.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// Corners go from (0, 0), the top left corner of the picture as it is shown, to (1, 1); a box may
/// lie partly outside.
struct PictureBox {
  std::string name;             ///< of what is in it, "face"
  uint64_t track = 0;           ///< the same in all frames of one thing; 0: not known
  Eigen::Vector2d place{0, 0};  ///< the corner that is nearer to (0, 0)
  Eigen::Vector2d far_corner{1, 1};
};

using PictureBoxes = std::vector<PictureBox>;

}  // namespace spidar
