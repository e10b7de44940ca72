// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frame pairs with the true displacement of every pixel (Baker et al.: A database and evaluation
/// methodology for optical flow, Int. J. Computer Vision 92, 2011).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/support/picture.h"

namespace spidar::bench {

/// Displacements by rows.
struct FlowField {
  int width = 0;
  int height = 0;
  std::vector<float> xy_px;

  /// Bilinear; nothing outside, and where one of the four neighbours is unknown.
  std::optional<Eigen::Vector2d> at(double x_px, double y_px) const;
};

/// Reads a .flo file. Throws std::runtime_error that names the file and what is wrong.
FlowField read_flow(const std::string& file);

struct FlowPair {
  std::string name;
  test::Picture before;
  test::Picture after;
  FlowField truth;
};

/// Each subfolder with frame10.png, frame11.png and flow10.flo, by name.
/// Throws std::runtime_error when there is none or a file cannot be read.
std::vector<FlowPair> read_pairs(const std::string& folder);

}  // namespace spidar::bench
