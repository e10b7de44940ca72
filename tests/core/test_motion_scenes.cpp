// What is felt of rendered scenes whose motion is known: a camera, and discs in front of it.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion_analyzer.h"
#include "tests/support/moving_scene.h"

namespace spidar {
namespace {

using test::MovingScene;
using test::Placement;

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;

/// A mean displacement over the frame is right to 0.03 px: see the tracker's test.
constexpr double kMean_px = 0.03;

AnalyzerSettings with(MotionKind kind) {
  AnalyzerSettings settings;
  settings.motion = kind;
  return settings;
}

TEST(CameraMotion, IsTheInverseOfThePicturesPan) {
  MovingScene scene(kWidth, kHeight);
  MotionAnalyzer analyzer(with(MotionKind::kCamera));
  for (int n = 0; n < 6; ++n) {
    const FrameAnalysis frame =
        analyzer.analyze(scene.draw({{-3.0 * n, 1.0 * n}}, {}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_STREQ(to_string(*frame.model), "translation") << n;
    const Eigen::Vector2d moved_px = frame.motion.velocity_px_s * kFrame_s;
    EXPECT_LT((moved_px - Eigen::Vector2d(3, -1)).norm(), kMean_px) << n;
    EXPECT_EQ(frame.motion.growth_1_s, 0);
    EXPECT_GT(frame.wrench.force_N.x(), 0);  // to the right
    EXPECT_GT(frame.wrench.force_N.y(), 0);  // up
  }
}

TEST(CameraMotion, SeesZoomAndRoll) {
  MovingScene scene(kWidth, kHeight);
  MotionAnalyzer analyzer(with(MotionKind::kCamera));
  for (int n = 0; n < 6; ++n) {
    const Placement background{{0, 0}, std::pow(1.01, n), 0.008 * n};
    const FrameAnalysis frame = analyzer.analyze(scene.draw(background, {}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_STREQ(to_string(*frame.model), "similarity") << n;
    // 0.03 px at 100 px from the centre, where the mean point is.
    const double tolerance = kMean_px / 100;
    EXPECT_NEAR(frame.motion.growth_1_s * kFrame_s, 1 / (1.01 * std::cos(0.008)) - 1, tolerance)
        << n;
    EXPECT_NEAR(frame.motion.roll_rad_s * kFrame_s, -0.008, tolerance) << n;
    EXPECT_LT(frame.motion.velocity_px_s.norm() * kFrame_s, 2 * kMean_px) << n;
  }
}

TEST(CameraMotion, IsExactlyNothingWhileOnlyADiscMoves) {
  MovingScene scene(kWidth, kHeight);
  scene.add_disc(40);
  MotionAnalyzer analyzer(with(MotionKind::kCamera));
  for (int n = 0; n < 8; ++n) {
    const FrameAnalysis frame =
        analyzer.analyze(scene.draw({}, {{{-120.0 + 8 * n, 10}}}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_EQ(frame.motion.velocity_px_s, Eigen::Vector2d::Zero()) << n;
    EXPECT_EQ(frame.wrench.stacked(), (Eigen::Matrix<double, 6, 1>::Zero())) << n;
    EXPECT_STREQ(to_string(*frame.model), "still") << n;
  }
}

}  // namespace
}  // namespace spidar
