// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The frames of a film, drawn before the time is measured.
#pragma once

#include <cmath>
#include <vector>

#include "tests/support/moving_scene.h"

namespace spidar::bench {

/// A camera that pans over a background with an object in front, which has 8 % of the picture.
/// Lengths are at a width of 640 px.
inline std::vector<test::Picture> pan_with_object(int width, int height) {
  constexpr int kFrames = 12;
  const double unit = width / 640.0;
  test::MovingScene scene(width, height);
  scene.add_disc(std::sqrt(0.08 * width * height / M_PI));
  std::vector<test::Picture> pictures;
  for (int n = 0; n < kFrames; ++n) {
    const Eigen::Vector2d wall_px = unit * n * Eigen::Vector2d(-4, 1.5);
    const Eigen::Vector2d disc_px = unit * (n - (kFrames - 1) / 2.0) * Eigen::Vector2d(9, 2.5);
    const ImageView view = scene.draw({wall_px}, {{disc_px}});
    pictures.emplace_back(width, height);
    pictures.back().pixels.assign(view.data, view.data + width * height);
  }
  return pictures;
}

}  // namespace spidar::bench
