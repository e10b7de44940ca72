// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A disc on a plain background after JPEG compression. Ringing around its rim makes corners in
// small windows, but these stay with the blocks of the codec when the disc moves.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "core/tracking/patch_tracker.h"
#include "tests/support/picture.h"

namespace spidar {
namespace {

using test::Picture;
using Block = Eigen::Matrix<double, 8, 8>;

/// Steps of luminance, ITU-T T.81 table K.1.
Block steps_of_quality(int quality) {
  Block steps;
  steps << 16, 11, 10, 16, 24, 40, 51, 61,  //
      12, 12, 14, 19, 26, 58, 60, 55,       //
      14, 13, 16, 24, 40, 57, 69, 56,       //
      14, 17, 22, 29, 51, 87, 80, 62,       //
      18, 22, 37, 56, 68, 109, 103, 77,     //
      24, 35, 55, 64, 81, 104, 113, 92,     //
      49, 64, 78, 87, 103, 121, 120, 101,   //
      72, 92, 95, 98, 112, 100, 103, 99;
  // As the Independent JPEG Group's library scales them, from quality 50 on.
  return ((2 - 0.02 * quality) * steps).array().round().max(1).matrix();
}

Block cosines() {
  Block c;
  for (int k = 0; k < 8; ++k) {
    for (int x = 0; x < 8; ++x) {
      c(k, x) = std::sqrt((k == 0 ? 1 : 2) / 8.0) * std::cos(M_PI * k * (2 * x + 1) / 16);
    }
  }
  return c;
}

/// Replaces a picture, whose sides are multiples of 8 px, by its compressed version. Returns the
/// largest change, grey levels.
int compress(int quality, Picture& picture) {
  int largest = 0;
  static const Block transform = cosines();
  const Block steps = steps_of_quality(quality);
  const ImageView view = picture.view();
  for (int y = 0; y < view.height; y += 8) {
    for (int x = 0; x < view.width; x += 8) {
      uint8_t* first = picture.pixels.data() + y * picture.stride + x;
      Block block;
      for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) block(i, j) = first[i * picture.stride + j] - 128.0;
      }
      block = (transform * block * transform.transpose()).cwiseQuotient(steps).array().round();
      block = transform.transpose() * block.cwiseProduct(steps) * transform;
      for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
          const double level = std::clamp(std::round(block(i, j) + 128), 0.0, 255.0);
          uint8_t& pixel = first[i * picture.stride + j];
          largest = std::max(largest, std::abs(static_cast<int>(level) - pixel));
          pixel = static_cast<uint8_t>(level);
        }
      }
    }
  }
  return largest;
}

constexpr double kRadius_px = 20;
constexpr double kRim_1_px = 110;  ///< grey levels a pixel, at its edge

/// Moves approximately like videotestsrc's ball in 320 × 240 px.
Eigen::Vector2d place(int frame) {
  return {160 + 140 * std::sin(2 * M_PI * frame / 200),
          120 + 100 * std::sin(2 * M_PI * frame / 200 * M_SQRT2)};
}

class CompressedDisc : public testing::TestWithParam<int> {};

TEST_P(CompressedDisc, IsFollowed) {
  Picture picture(320, 240);
  PatchTracker tracker;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const Eigen::Vector2d centre = place(n);
    picture.fill([&](double x, double y) {
      const double inside_px = kRadius_px - std::hypot(x - centre.x(), y - centre.y());
      return 16 + std::clamp(kRim_1_px * inside_px, 0.0, 219.0);
    });
    const int ringing = compress(GetParam(), picture);
    const TrackedFrame& frame = tracker.track(picture.view());
    // The second picture tells that small windows do not last, in the third there are others.
    if (n < 2) continue;
    EXPECT_FALSE(frame.restarted);
    EXPECT_FALSE(frame.tracks.empty());
    if (frame.tracks.empty()) continue;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Track& track : frame.tracks) {
      mean += Eigen::Vector2d(static_cast<double>(track.to.x_px - track.from.x_px),
                              static_cast<double>(track.to.y_px - track.from.y_px));
    }
    mean /= static_cast<double>(frame.tracks.size());
    // As far off as if all of the rim were by the codec's largest error too light or too dark.
    EXPECT_LT((mean - (centre - place(n - 1))).norm(), ringing / kRim_1_px);
  }
}

INSTANTIATE_TEST_SUITE_P(Qualities, CompressedDisc, testing::Values(50, 70, 85, 95));

}  // namespace
}  // namespace spidar
