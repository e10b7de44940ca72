// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A disc on a plain background after JPEG compression. Ringing around its rim makes corners in
// small windows, but these stay with the blocks of the codec when the disc moves.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar::test::compressed_disc_test {
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

/// Replaces a picture, whose sides are multiples of 8 px, by its compressed version.
void compress(int quality, Picture& picture) {
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
          pixel = static_cast<uint8_t>(level);
        }
      }
    }
  }
}

constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kRadius_px = 20;
constexpr double kRim_1_px = 110;  ///< grey levels a pixel, at its edge

/// Moves approximately like videotestsrc's ball in 320 × 240 px.
Eigen::Vector2d position(int frame) {
  return {160 + 140 * std::sin(2 * M_PI * frame / 200),
          120 + 100 * std::sin(2 * M_PI * frame / 200 * M_SQRT2)};
}

class CompressedDisc : public testing::TestWithParam<int> {};

TEST_P(CompressedDisc, IsFollowed) {
  Picture picture(320, 240);
  MotionAnalyzer analyzer;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const Eigen::Vector2d centre = position(n);
    picture.fill([&](double x, double y) {
      const double inside_px = kRadius_px - std::hypot(x - centre.x(), y - centre.y());
      return 16 + std::clamp(kRim_1_px * inside_px, 0.0, 219.0);
    });
    compress(GetParam(), picture);
    const Frame frame = analyzer.analyze(picture.view(), n * kFrame_ns);
    // An object is felt from the second pair of frames in which it moves.
    if (n < 2) continue;
    const Eigen::Vector2d moved_px = frame.motion.velocity_px_s * 1e-9 * kFrame_ns;
    // What a search by whole pixels leaves: blocks on the rim show both disc and background, which
    // the codec changes, so that the refinement may not gain anything.
    EXPECT_LT((moved_px - (centre - position(n - 1))).norm(), 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(Qualities, CompressedDisc, testing::Values(50, 70, 85, 95));

}  // namespace
}  // namespace spidar::test::compressed_disc_test
