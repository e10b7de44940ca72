// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The motion that is felt in rendered scenes of known motion: a camera, and discs in front of it.
#include "core/analysis/force_renderer.h"
#include "core/analysis/motion_analyzer.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::motion_scenes_test {
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
  settings.controller.alpha_s_px = 0.01;  // so steep that these motions give most of the force
  return settings;
}

TEST(CameraMotion, IsTheInverseOfThePicturesPan) {
  MovingScene scene(kWidth, kHeight);
  MotionAnalyzer analyzer(with(MotionKind::kCamera));
  for (int n = 0; n < 6; ++n) {
    const Frame frame = analyzer.analyze(scene.draw({{-3.0 * n, 1.0 * n}}, {}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_STREQ(to_string(frame.background->model.kind), "translation") << n;
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
    const Frame frame = analyzer.analyze(scene.draw(background, {}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_STREQ(to_string(frame.background->model.kind), "similarity") << n;
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
    const Frame frame = analyzer.analyze(scene.draw({}, {{{-120.0 + 8 * n, 10}}}), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_EQ(frame.motion.velocity_px_s, Eigen::Vector2d::Zero()) << n;
    EXPECT_EQ(frame.wrench.stacked(), (Eigen::Matrix<double, 6, 1>::Zero())) << n;
    EXPECT_STREQ(to_string(frame.background->model.kind), "still") << n;
  }
}

/// An object that moves by less in a frame may pass for rest: three times the accuracy of a block.
constexpr double kRests_px = 3 * 0.1;

/// What is left of a velocity, and what is beside it, over many frames.
struct Comparison {
  double along = 0;               ///< Σ found · true
  double square = 0;              ///< Σ true²
  std::vector<double> errors_px;  ///< of each displacement
  int missed = 0;                 ///< frames without anything felt although the object moves

  void add(const Frame& frame, const Eigen::Vector2d& moved_px) {
    const Eigen::Vector2d found_px = frame.motion.velocity_px_s * kFrame_s;
    along += found_px.dot(moved_px);
    square += moved_px.squaredNorm();
    errors_px.push_back((found_px - moved_px).norm());
    missed += frame.motion.tracked == 0 && moved_px.norm() > kRests_px;
  }
  double left() const { return along / square; }
  double worst_px() const { return *std::max_element(errors_px.begin(), errors_px.end()); }
  double median_px() {
    const auto middle = errors_px.begin() + static_cast<ptrdiff_t>(errors_px.size() / 2);
    std::nth_element(errors_px.begin(), middle, errors_px.end());
    return *middle;
  }
};

/// A disc that goes back and forth in a curve, before a camera that pans by `pan_px` a frame.
Comparison follow_disc(MotionKind kind, double radius_px, const Eigen::Vector2d& pan_px,
                       double speed, bool plain = false, uint32_t seed = 1) {
  MovingScene scene(kWidth, kHeight, seed);
  if (plain) scene.plain_background();
  scene.add_disc(radius_px);
  MotionAnalyzer analyzer(with(kind));
  const auto position = [speed](int n) {
    return Eigen::Vector2d(110 * std::sin(0.06 * speed * n), 50 * std::cos(0.1 * speed * n));
  };
  Comparison comparison;
  for (int n = 0; n < 40; ++n) {
    const Frame frame = analyzer.analyze(scene.draw({n * pan_px}, {{position(n)}}), n * kFrame_ns);
    // The object is known from the second pair of frames on; a birth may take longer.
    if (n > 4) comparison.add(frame, position(n) - position(n - 1) - pan_px);
  }
  return comparison;
}

/// Windows that see nothing but the disc are right to 0.1 px (tracker's test). Those at its edge
/// are taken for its own up to 3 σ = 0.3 px or 6 % of the displacement off: if half of them are,
/// the mean is off by half of both.
double tolerance_px(double fastest_px) {
  return (0.1 + std::max(0.3, 0.06 * fastest_px)) / 2;
}

TEST(ObjectMotion, IsTheDiscsInFrontOfATextureWhereTheMeanLosesIt) {
  // 7.6 % of the picture.
  const Comparison mean = follow_disc(MotionKind::kMean, 56, {0, 0}, 1);
  EXPECT_LT(mean.left(), 0.2);
  for (const uint32_t seed : {1u, 2u, 3u}) {
    for (const MotionKind kind : {MotionKind::kObject, MotionKind::kObjects}) {
      Comparison object = follow_disc(kind, 56, {0, 0}, 1, false, seed);
      std::printf("speed left: mean %.3f, object %.3f; median error %.3f px\n", mean.left(),
                  object.left(), object.median_px());
      EXPECT_NEAR(object.left(), 1, 0.03) << "seed " << seed;
      // In single frames points that slide along the rim outnumber those on the disc: in the middle
      // it is as exact as a window that sees nothing but the disc.
      EXPECT_LT(object.median_px(), 0.1) << "seed " << seed;
      EXPECT_EQ(object.missed, 0) << "seed " << seed;
    }
  }
}

TEST(ObjectMotion, IsRelativeToTheBackgroundOfAPan) {
  const Eigen::Vector2d pan_px(-3, 1);
  // The mean is that of the pan, and turns the motion round.
  EXPECT_LT(follow_disc(MotionKind::kMean, 56, pan_px, 1).left(), 0);
  for (const double speed : {1.0, 2.0}) {
    const Comparison object = follow_disc(MotionKind::kObject, 56, pan_px, speed);
    EXPECT_NEAR(object.left(), 1, 0.03);
    EXPECT_LT(object.worst_px(), tolerance_px(20)) << "speed " << speed;
    EXPECT_EQ(object.missed, 0);
  }
}

TEST(ObjectMotion, KeepsTheSpeedOfADiscOnAPlainBackground) {
  // Of a single frame, half a pixel in both directions: what a search by whole pixels leaves, since
  // all blocks of the small disc show its rim and the background, too.
  const double worst_px = std::sqrt(0.5);
  for (const double radius_px : {14.0, 56.0}) {
    const Comparison object = follow_disc(MotionKind::kObject, radius_px, {0, 0}, 1, true);
    EXPECT_NEAR(object.left(), 1, 0.01) << radius_px;
    EXPECT_LT(object.worst_px(), worst_px) << radius_px;
  }
}

TEST(ObjectMotion, IsExactlyNothingWhereOnlyTheCameraMoves) {
  for (const double growth : {0.0, 0.01}) {
    MovingScene scene(kWidth, kHeight);
    MotionAnalyzer analyzer(with(MotionKind::kObject));
    for (int n = 0; n < 8; ++n) {
      const Placement background{{-3.0 * n, 2.0 * n}, 1 + growth * n, growth / 2 * n};
      const Frame frame = analyzer.analyze(scene.draw(background, {}), n * kFrame_ns);
      EXPECT_EQ(frame.motion.velocity_px_s, Eigen::Vector2d(0, 0)) << n;
      EXPECT_EQ(frame.objects.size(), 0u) << n;
    }
  }
}

TEST(ObjectMotion, TheForceOfADiscThatVanishesFades) {
  MovingScene scene(kWidth, kHeight);
  scene.add_disc(40);
  AnalyzerSettings usual;  // not so steep that the largest force hides an error
  usual.motion = MotionKind::kObject;
  MotionAnalyzer analyzer(usual);
  constexpr double kShort_s = 0.02;
  constexpr int kVanishes = 12;
  double full_N = 0;
  double before_N = 0;
  for (int n = 0; n < kVanishes + 12; ++n) {
    // The camera moves, so that no picture repeats the one before.
    const Placement background{{-1.5 * n, 0}};
    const Placement disc{{n < kVanishes ? -60.0 + 4 * n : 10'000.0, 0}};
    const double now_N =
        analyzer.analyze(scene.draw(background, {disc}), static_cast<int64_t>(n * kShort_s * 1e9))
            .wrench.force_N.norm();
    if (n < kVanishes) {
      full_N = std::max(full_N, now_N);
    } else {
      EXPECT_LT(before_N - now_N, full_N * kShort_s / WrenchFade::kFade_s + 1e-9) << n;
    }
    before_N = now_N;
  }
  EXPECT_GT(full_N, 1);
  EXPECT_EQ(before_N, 0);
}

TEST(ObjectMotion, ADiscThatGrowsAndTurnsGivesForceAndTorque) {
  for (const double sign : {1.0, -1.0}) {
    MovingScene scene(kWidth, kHeight);
    scene.plain_background();
    scene.add_disc(60);
    MotionAnalyzer analyzer(with(MotionKind::kObject));
    for (int n = 0; n < 8; ++n) {
      const Placement disc{{0, 0}, std::pow(1.02, sign * n), 0.02 * sign * n};
      const Frame frame = analyzer.analyze(scene.draw({}, {disc}), n * kFrame_ns);
      if (n < 3) continue;  // the points become denser once something moves
      // A mean right to 0.03 px, of points that are 30 px from the middle on average; and of the
      // turn, which the plain background behind the rim does not share, a third of the points
      // (within 11 px of it: half the diagonal of a window of 16 px) may lose a quarter.
      EXPECT_NEAR(frame.motion.growth_1_s * kFrame_s, std::pow(1.02, sign) * std::cos(0.02) - 1,
                  kMean_px / 30)
          << n;
      EXPECT_NEAR(frame.motion.roll_rad_s * kFrame_s, 0.02 * sign, kMean_px / 30 + 0.02 / 12) << n;
      // Nearer: towards the viewer. Clockwise on the screen: against the device's sense of turn.
      EXPECT_GT(sign * frame.wrench.force_N.z(), 0.5) << n;
      EXPECT_LT(sign * frame.wrench.torque_Nm.z(), -0.5 * kTorqueArm_m) << n;
    }
  }
}

}  // namespace
}  // namespace spidar::test::motion_scenes_test
