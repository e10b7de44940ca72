// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracker on a texture that moves by a known displacement.
#pragma once

#include "core/points/tracker.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test {

/// Frame pixels to one pixel of the picture in which points are followed; its longer side is about
/// 480 px.
inline double reduction(int width, int height) {
  return std::max(1.0, std::round(std::max(width, height) / 480.0));
}

/// A single displacement, px of the reduced picture. The iteration stops at steps of 0.01 px;
/// rounding to grey levels is σ = 0.29 √2 over the gradient of about 10 levels / px and the square
/// root of the window's 225 px: 0.003 px; the rest is the bilinear interpolation of a texture with
/// structures of some 8 px, whose error between the pixels is up to h²/8 · f'' ≈ 1/8 · 10 · 2π/16 ≈
/// 0.5 levels, that is 0.05 px if all of the window erred the same way.
constexpr double kPointTolerance_px = 0.1;
/// The mean over a hundred of them, whose interpolation errors differ in sign.
constexpr double kMeanTolerance_px = 0.03;

class MovingTexture {
 public:
  MovingTexture(int width, int height, double dx_px, double dy_px, uint32_t seed = 5)
      : picture_(width, height, 3),
        texture_(seed, 8 * reduction(width, height)),
        dx_px_(dx_px),
        dy_px_(dy_px) {}

  ImageView frame(int n) {
    picture_.fill([&](double x, double y) { return texture_.at(x - n * dx_px_, y - n * dy_px_); });
    return picture_.view();
  }

 private:
  Picture picture_;
  Texture texture_;
  double dx_px_;
  double dy_px_;
};

inline double dx(const FollowedPoint& t) {
  return static_cast<double>(t.to.x_px) - static_cast<double>(t.from.x_px);
}
inline double dy(const FollowedPoint& t) {
  return static_cast<double>(t.to.y_px) - static_cast<double>(t.from.y_px);
}
}  // namespace spidar::test
