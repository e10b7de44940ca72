// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Roll and growth of balls that turn, grow, or do neither, from what the pixels determine of them.
#include "core/motion/objects/turn_meter.h"
#include "tests/support/test.h"
#include "tests/support/turning_ball.h"

namespace spidar::test::turning_ball_test {
namespace {

constexpr double kSwing = 1.2;  // rad/s, or 1/s
/// Changes beyond the truth's are at most this fraction of the size of the motion.
constexpr double kQuarter = 0.25 * kSwing;
/// A swing of 8 s passes through zero ten times; it may go to none and come back each time.
constexpr int kMaxSwitches = 20;
/// Of a ball that does not turn: 12 times less than of one that does.
constexpr double kMaxOfNone = 0.1;

void expect_steady(const FollowedAxis& axis) {
  EXPECT_LE(axis.switches(), kMaxSwitches);
  EXPECT_LE(axis.jump(), kQuarter);
  EXPECT_LE(axis.error(0.99), kQuarter);
}

TEST(TurningBall, OfSixFlatSectorsTurnsSmoothly) {
  const FollowedBall ball = follow({false, 36, kSwing, 0, false});
  expect_steady(ball.roll_rad_s);
  EXPECT_LE(ball.growth_1_s.error(0.99), kMaxOfNone);
}

TEST(TurningBall, OfSixFlatSectorsGrowsSmoothlyInAHand) {
  const FollowedBall ball = follow({false, 36, 0, kSwing, true});
  expect_steady(ball.growth_1_s);
  EXPECT_LE(ball.roll_rad_s.error(0.99), kMaxOfNone);
}

TEST(TurningBall, ThatOnlyGoesRoundHasNoTorque) {
  const FollowedBall ball = follow({false, 36, 0, 0, false});
  for (const FollowedAxis& axis : {ball.roll_rad_s, ball.growth_1_s}) {
    EXPECT_LE(axis.error(0.99), kMaxOfNone);
    EXPECT_LE(axis.switches(), kMaxSwitches);
  }
}

TEST(TurningBall, WithATextureTurnsAndGrows) {
  const FollowedBall ball = follow({true, 36, kSwing, kSwing, false});
  expect_steady(ball.roll_rad_s);
  expect_steady(ball.growth_1_s);
}

/// Nothing shows how a disc of one grey level turns.
TEST(TurningBall, OfOneGreyLevelGrowsAndDoesNotTurn) {
  MovingScene scene(640, 360);
  scene.add_disc(36, [](const Eigen::Vector2d&) { return 230; });
  MotionAnalyzer analyzer;
  double most_rad_s = 0, least_1_s = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 30; ++n) {
    const double growth = 0.03, turn_rad = 0.04;
    const Placement disc{{-80.0 + 4 * n, 0}, std::pow(1 + growth, n), turn_rad * n};
    const Frame& frame = analyzer.analyze(scene.draw({}, {disc}), n * 40'000'000LL);
    if (n < TurningBall::kFirst) continue;
    most_rad_s = std::max(most_rad_s, std::abs(frame.motion.roll_rad_s));
    least_1_s = std::min(least_1_s, frame.motion.growth_1_s * 0.04 / growth);
  }
  EXPECT_LE(most_rad_s, 0.25 * 1.0);  // a quarter of how it does turn
  EXPECT_GT(least_1_s, 0.7);
}

/// One is felt, and the others are measured by turns: each in every third frame.
TEST(TurningBall, AmongFourIsKnownLikeTheOneThatIsFelt) {
  constexpr std::array<double, 4> kTurns_rad = {0.03, -0.03, 0.02, -0.02};
  MovingScene scene(640, 360);
  for (size_t k = 0; k < kTurns_rad.size(); ++k) scene.add_disc(36);
  MotionAnalyzer analyzer;
  const Frame* frame = nullptr;
  for (int n = 0; n < 24; ++n) {
    std::vector<Placement> discs;
    for (size_t k = 0; k < kTurns_rad.size(); ++k) {
      discs.push_back({{-240.0 + 140 * static_cast<double>(k) + 3 * n, 0}, 1, kTurns_rad[k] * n});
    }
    frame = &analyzer.analyze(scene.draw({}, discs), n * 40'000'000LL);
  }
  std::vector<MovingObject> objects = frame->objects;
  ASSERT_EQ(objects.size(), kTurns_rad.size());
  std::sort(objects.begin(), objects.end(), [](const MovingObject& a, const MovingObject& b) {
    return a.position_px.x() < b.position_px.x();
  });
  for (size_t k = 0; k < objects.size(); ++k) {
    const double true_rad_s = kTurns_rad[k] / 0.04;
    EXPECT_NEAR(objects[k].roll_rad_s, true_rad_s, 0.25 * std::abs(true_rad_s)) << k;
  }
}

TEST(SteadyRate, ComesInAboveItsErrorAndFadesWithoutEvidence) {
  SteadyRate rate;
  constexpr double kFrame_s = 0.04;
  rate.update({0.001, 0.001, 0}, kFrame_s);
  EXPECT_EQ(rate.rate_1_s(), 0);  // within the error
  for (int n = 0; n < 50; ++n) rate.update({0.04, 0.001, 0}, kFrame_s);
  const double full_1_s = rate.rate_1_s();
  EXPECT_NEAR(full_1_s, 1, 0.01);
  // An error of 3, of which 2.45 · 3 are the bound b: a change by 2 counts for 4 / (4 + b²) = 0.07.
  rate.update({-0.04, 0.12, 0}, kFrame_s);
  EXPECT_GT(rate.rate_1_s(), full_1_s / 2);
  for (int n = 0; n < 50; ++n) rate.update({0.04, 0.001, 0}, kFrame_s);
  const double last_1_s = rate.rate_1_s();
  rate.update(Estimate(), kFrame_s);
  // The bound of the error, 2.45 · 0.025, takes at most its square of what is left, 0.67.
  EXPECT_NEAR(rate.rate_1_s() / last_1_s, std::exp(-kFrame_s / SteadyRate::kFades_s), 0.01);
  for (int n = 0; n < 12; ++n) rate.update(Estimate(), kFrame_s);
  EXPECT_EQ(rate.rate_1_s(), 0);
}

}  // namespace
}  // namespace spidar::test::turning_ball_test
