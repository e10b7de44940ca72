// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which of several objects is felt, depending on the pointer, and what is kept when another motion
// is selected.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/motion_estimator.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::pointer_test {
namespace {

constexpr int kHeight = 400;
constexpr double kRounding = 1e-12;

MovingObject object(double x_px, double y_px, double size_px, double speed_px_s) {
  MovingObject made;
  made.position_px << x_px, y_px;
  made.area_px2 = (size_px + 10) * (size_px + 10);
  made.size_px.setConstant(size_px);
  made.relative_px_s << speed_px_s, 0;
  made.growth_1_s = speed_px_s / 100;
  made.roll_rad_s = -speed_px_s / 100;
  made.error_px_s = 1 / DeadZone::kOfBound;
  made.points = 10;
  return made;
}

TEST(Pointer, IsOnOneOfTwoObjectsAndThatOneIsFelt) {
  const std::vector<MovingObject> objects = {object(-150, 0, 60, 80), object(150, 0, 60, -40)};
  // The edge of the other box is 300 − 30 px away: 2.7 σ.
  const double other = std::exp(-2.7 * 2.7 / 2);
  const auto mean = [&](double near, double far) { return (near + other * far) / (1 + other); };
  const ImageMotion left = motion_at_pointer(objects, {-150, 0}, kHeight);
  EXPECT_NEAR(left.velocity_px_s.x(), mean(80, -40), kRounding);
  EXPECT_NEAR(left.growth_1_s, mean(0.8, -0.4), kRounding);
  EXPECT_NEAR(left.roll_rad_s, mean(-0.8, 0.4), kRounding);
  EXPECT_EQ(left.tracked, 20);
  EXPECT_NEAR(left.dead_zone_px_s, std::sqrt(1 + other * other) / (1 + other), kRounding);
  const ImageMotion right = motion_at_pointer(objects, {150, 0}, kHeight);
  EXPECT_NEAR(right.velocity_px_s.x(), mean(-40, 80), kRounding);
  // In the middle between two of one size it is their mean.
  EXPECT_NEAR(motion_at_pointer(objects, {0, 0}, kHeight).velocity_px_s.x(), 20, kRounding);
}

TEST(Pointer, WithinAnObjectOnlySizesCount) {
  // Both boxes hold the pointer; areas are (90 + 10)² and (190 + 10)².
  const std::vector<MovingObject> objects = {object(-40, 0, 90, 10), object(60, 0, 190, 60)};
  EXPECT_NEAR(motion_at_pointer(objects, {-20, 10}, kHeight).velocity_px_s.x(),
              (10 * 1 + 60 * 4) / 5.0, kRounding);
}

TEST(Pointer, ALoneObjectIsFeltAsItIsHoweverFar) {
  const std::vector<MovingObject> objects = {object(-300, -150, 30, 70)};
  EXPECT_NEAR(motion_at_pointer(objects, {300, 190}, kHeight).velocity_px_s.x(), 70, kRounding);
}

TEST(Pointer, NothingInSightIsNothing) {
  std::vector<MovingObject> objects = {object(0, 0, 60, 80)};
  objects[0].points = 0;
  const ImageMotion motion = motion_at_pointer(objects, {0, 0}, kHeight);
  EXPECT_EQ(motion.velocity_px_s, Eigen::Vector2d(0, 0));
  EXPECT_EQ(motion.tracked, 0);
  EXPECT_EQ(motion_at_pointer({}, {0, 0}, kHeight).tracked, 0);
}

constexpr int64_t kFrame_ns = 40'000'000;

/// Two discs that go apart before a plain wall.
class TwoDiscs {
 public:
  TwoDiscs() {
    scene_.plain_background();
    scene_.add_disc(40);
    scene_.add_disc(40);
  }
  Frame next(MotionAnalyzer& analyzer) {
    const int n = frames_++;
    return analyzer.analyze(scene_.draw({}, {{{-110.0 - 3 * n, 0}}, {{110.0 + 3 * n, 0}}}),
                            n * kFrame_ns);
  }

 private:
  test::MovingScene scene_{480, 270};
  int frames_ = 0;
};

AnalyzerSettings with(MotionKind kind) {
  AnalyzerSettings settings;
  settings.motion = kind;
  return settings;
}

TEST(MotionKinds, ObjectsAreForgottenWhileTheMeanIsFelt) {
  TwoDiscs discs;
  MotionAnalyzer analyzer(with(MotionKind::kObject));
  for (int n = 0; n < 6; ++n) discs.next(analyzer);
  analyzer.configure(with(MotionKind::kObjects));
  EXPECT_EQ(discs.next(analyzer).objects.size(), 2u) << "another kind that needs them: they go on";
  analyzer.configure(with(MotionKind::kMean));
  EXPECT_EQ(discs.next(analyzer).objects.size(), 0u);
  analyzer.configure(with(MotionKind::kObject));
  EXPECT_FALSE(discs.next(analyzer).has_motion_before())
      << "the mean keeps no picture to compare with";
  EXPECT_EQ(discs.next(analyzer).objects.size(), 0u) << "found when they are seen a second time";
  EXPECT_EQ(discs.next(analyzer).objects.size(), 2u);
}

/// The motion of the camera needs to know what moves by itself.
TEST(MotionKinds, ObjectsAreKeptButNotReportedWhileTheCameraIsFelt) {
  TwoDiscs discs;
  MotionAnalyzer analyzer(with(MotionKind::kObject));
  for (int n = 0; n < 6; ++n) discs.next(analyzer);
  analyzer.configure(with(MotionKind::kCamera));
  const Frame camera = discs.next(analyzer);
  EXPECT_EQ(camera.objects.size(), 2u) << "whatever is felt of them";
  analyzer.configure(with(MotionKind::kObject));
  EXPECT_EQ(discs.next(analyzer).objects.size(), 2u);
}

}  // namespace
}  // namespace spidar::test::pointer_test
