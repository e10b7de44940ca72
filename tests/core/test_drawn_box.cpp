// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The box to draw around an object moves as the object does, though blocks come and go at its rim.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::drawn_box_test {
namespace {

using Eigen::Vector2d;

constexpr int kFrames = 40;
const Vector2d kStep_px(1.3, 0.7);  // a frame

/// How far the corners of the only object go from frame to frame more than it goes, at most; and by
/// how much the size of the box around its blocks changes.
struct Jumps {
  double drawn_px = 0;
  double size_px = 0;
  int frames = 0;
};

Jumps jumps_in(int width, int height) {
  const Texture wall(1, 10), ball(2, 10);
  const double radius_px = 0.3 * std::min(width, height);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1.5);
  MotionAnalyzer analyzer;
  Jumps jumps;
  const MovingObject* before = nullptr;
  MovingObject kept;
  for (int n = 0; n < kFrames; ++n) {
    const Vector2d centre_px = Vector2d(0.35 * width, 0.4 * height) + n * kStep_px;
    Picture picture(width, height);
    picture.fill([&](double x, double y) {
      const Vector2d on = Vector2d(x, y) - centre_px;
      const bool is_ball = on.norm() < radius_px;
      const double grey = is_ball ? ball.at(on.x(), on.y()) : wall.at(x, y);
      return std::clamp(grey + noise(random), 0.0, 255.0);
    });
    const Frame& frame = analyzer.analyze(picture.view(), n * kSceneFrame_ns);
    if (frame.objects.size() != 1 || frame.objects[0].points == 0) {
      before = nullptr;
      continue;
    }
    const MovingObject& object = frame.objects[0];
    if (before && before->id == object.id) {
      const Vector2d low_px = object.drawn_low_px() - before->drawn_low_px() - kStep_px;
      const Vector2d high_px = object.drawn_high_px() - before->drawn_high_px() - kStep_px;
      jumps.drawn_px =
          std::max({jumps.drawn_px, low_px.cwiseAbs().maxCoeff(), high_px.cwiseAbs().maxCoeff()});
      jumps.size_px =
          std::max(jumps.size_px, (object.size_px - before->size_px).cwiseAbs().maxCoeff());
      ++jumps.frames;
    }
    kept = object;
    before = &kept;
  }
  return jumps;
}

TEST(DrawnBox, MovesAsTheObjectDoes) {
  double largest_change_px = 0;
  for (const auto& [width, height] : {std::pair{257, 321}, {192, 321}, {129, 289}, {129, 97}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const Jumps jumps = jumps_in(width, height);
    EXPECT_GT(jumps.frames, kFrames / 2);
    // A corner is less than a block away from that of the blocks, which jumps by up to two, and
    // goes a tenth of the way (Track::kBoxSettles_s); its motion is known to a pixel a frame.
    EXPECT_LT(jumps.drawn_px, 0.1 * 3 * kBlock_px + 1);
    largest_change_px = std::max(largest_change_px, jumps.size_px);
  }
  EXPECT_GE(largest_change_px, kBlock_px) << "the blocks themselves jump";
}

TEST(DrawnBox, IsNotFarFromTheObject) {
  constexpr int kFew = 15;
  const Texture wall(1, 10), ball(2, 10);
  MotionAnalyzer analyzer;
  Frame frame;
  const Vector2d step_px(3, 0);
  for (int n = 0; n < kFew; ++n) {
    const Picture picture = draw(
        [&](int k, const Vector2d& at) {
          const Vector2d on = at - Vector2d(150, 180) - k * step_px;
          return on.norm() < 60 ? ball.at(on.x(), on.y()) : wall.at(at.x(), at.y());
        },
        n);
    frame = analyzer.analyze(picture.view(), n * kSceneFrame_ns);
  }
  ASSERT_EQ(frame.objects.size(), 1u);
  // From the middle of the frame. Blocks belong to it that it covers by half, and the box is within
  // a block of theirs; a block of the reduced picture has up to twice the side in the frame.
  const Vector2d middle_px =
      Vector2d(150, 180) + (kFew - 1) * step_px - Vector2d(kSceneWidth, kSceneHeight) / 2;
  const double most_px = 2 * 1.5 * kBlock_px;
  EXPECT_LT((frame.objects[0].drawn_low_px() - middle_px + Vector2d(60, 60)).cwiseAbs().maxCoeff(),
            most_px);
  EXPECT_LT((frame.objects[0].drawn_high_px() - middle_px - Vector2d(60, 60)).cwiseAbs().maxCoeff(),
            most_px);
}

}  // namespace
}  // namespace spidar::test::drawn_box_test
