// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a budget leaves out: a smaller picture, in which objects stay what they are.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "core/analysis/motion_analyzer.h"
#include "core/field/block_search.h"
#include "core/field/field_picture.h"
#include "tests/support/scene_film.h"
#include "tests/support/texture.h"

namespace spidar::test::less_work_test {
namespace {

TEST(LessWork, ThePictureIsSmaller) {
  EXPECT_EQ(field_scale(427, 240, 1), FieldScale::kTwoThirds);
  EXPECT_EQ(field_scale(427, 240, 3), FieldScale::kThird);
  EXPECT_EQ(field_scale(640, 360, 3), FieldScale::kQuarter);
  EXPECT_EQ(field_scale(640, 360, 9), FieldScale::kQuarter) << "there is no smaller one";
  EXPECT_EQ(field_scale(160, 120, 3), FieldScale::kTwoThirds) << "of half, a quarter has no block";
}

TEST(LessWork, ASmallerPictureHasTheMeanOfItsArea) {
  PaddedImage base, half, picture;
  base.resize(72, 48);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 72; ++x) base.row(y)[x] = static_cast<uint8_t>(2 * x + y);
  }
  base.repeat_border();
  for (const FieldScale scale : {FieldScale::kThird, FieldScale::kQuarter}) {
    const auto pixels = static_cast<int>(pixels_to_one(scale));
    reduce_to_field(base, scale, half, picture);
    ASSERT_EQ(picture.width(), 72 / pixels);
    ASSERT_EQ(picture.height(), 48 / pixels);
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        // Of a slope the value in the middle, and each of two reductions is rounded. Every second
        // row of four is read, whose middle is half a pixel higher.
        const double middle = (pixels - 1) / 2.0;
        const double value = 2 * (pixels * x + middle) + pixels * y + middle;
        EXPECT_NEAR(picture.row(y)[x], value, scale == FieldScale::kThird ? 1 : 0.5 + 0.5);
      }
    }
  }
}

TEST(LessWork, AFinerGridHasInEachBlockWhatWasThere) {
  // Two by two blocks become four by four, which divide each of them.
  const GridChange change{BlockGrid::over(32, 32), BlockGrid::over(64, 64), 2};
  std::vector<int> values{1, 2, 3, 4};
  change.apply(values);
  EXPECT_EQ(values, (std::vector<int>{1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 4, 4}));
  const GridChange back{change.to, change.from, 0.5};
  back.apply(values);
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3, 4}));
  std::vector<int> none;
  change.apply(none);
  EXPECT_TRUE(none.empty());
}

/// A disc that moves before a camera that pans. Its radius is larger than two blocks of the
/// coarsest picture, which are 64 px of these frames wide.
double grey(int n, const Eigen::Vector2d& at_px) {
  static const Texture wall(1, 10);
  static const Texture disc(3, 10);
  constexpr double kRadius_px = 90;
  const Eigen::Vector2d on_disc = at_px - Eigen::Vector2d(100 + 6 * n, 180);
  if (on_disc.norm() < kRadius_px) return disc.at(on_disc.x(), on_disc.y());
  return wall.at(at_px.x() + 2 * n, at_px.y() - n);
}

TEST(LessWork, ObjectsKeepTheirIdAndTheForceDoesNotJump) {
  constexpr int kRungs[] = {0, 4, 1, 3, 2, 0, 2, 1};
  constexpr int kFramesOnRung = 8;
  // It is an object from the second pair of frames on, and the force rises for some more.
  constexpr int kFound = 2;
  constexpr int kRisen = 5;
  AnalyzerSettings settings;
  MotionAnalyzer analyzer(settings);
  std::set<uint32_t> ids;
  Eigen::Vector3d last_N = Eigen::Vector3d::Zero();
  double largest_step_N = 0;
  for (int n = 0; n < static_cast<int>(std::size(kRungs)) * kFramesOnRung; ++n) {
    settings.less_work = kRungs[n / kFramesOnRung];
    analyzer.configure(settings);
    const FrameAnalysis found = analyzer.analyze(draw(grey, n).view(), n * kSceneFrame_ns);
    ASSERT_EQ(found.restarted, n == 0) << n;
    if (n < kFound) continue;
    EXPECT_NE(found.felt_object, 0u) << n;
    ids.insert(found.felt_object);
    const Eigen::Vector3d step_N = found.wrench.force_N - last_N;
    if (n >= kRisen) largest_step_N = std::max(largest_step_N, step_N.norm());
    last_N = found.wrench.force_N;
  }
  EXPECT_EQ(ids.size(), 1u);
  // About the Weber fraction of the hand (docs/feeling.md).
  EXPECT_LT(largest_step_N, 0.1 * last_N.norm());
}

TEST(LessWork, OtherRungsThanThereAreAreRefused) {
  for (const int rung : {-1, 5}) {
    AnalyzerSettings settings;
    settings.less_work = rung;
    EXPECT_THROW(MotionAnalyzer{settings}, std::invalid_argument) << rung;
  }
}

}  // namespace
}  // namespace spidar::test::less_work_test
