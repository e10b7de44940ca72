// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films defined by a function for the grey level at each position, and the result of their
/// analysis.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>

#include <Eigen/Core>

#include "tests/support/picture.h"

namespace spidar::test {

/// Grey level at a position of frame n, in px from the upper left corner.
using Scene = std::function<double(int n, const Eigen::Vector2d& at_px)>;

/// A film of 640 × 360 px at 25 frames a second.
constexpr int kSceneWidth = 640;
constexpr int kSceneHeight = 360;
constexpr int64_t kSceneFrame_ns = 40'000'000;
constexpr double kSceneFrame_s = 0.04;

/// Frame n with sensor noise of 1.5 grey levels, as in the films of the benchmark.
inline Picture draw(const Scene& scene, int n) {
  Picture picture(kSceneWidth, kSceneHeight);
  std::mt19937 random(static_cast<uint32_t>(n));
  std::normal_distribution<double> noise(0, 1.5);
  picture.fill([&](double x, double y) {
    return std::clamp(scene(n, {x, y}) + noise(random), 0.0, 255.0);
  });
  return picture;
}

inline bool in_disc(const Eigen::Vector2d& at_px, const Eigen::Vector2d& centre_px,
                    double radius_px) {
  return (at_px - centre_px).norm() < radius_px;
}

}  // namespace spidar::test
