#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/objects.h"
#include "track_world.h"

namespace spidar {
namespace {

using test::sample_model;
using test::Thing;
using test::World;

constexpr int kWidth = World::kWidth;
constexpr int kHeight = World::kHeight;
constexpr double kFrame_s = World::kFrame_s;
constexpr double kSigma_px = World::kSigma_px;

/// The mean of n displacements, half of them left out at worst, plus the background's error, which
/// is a tenth of that: 5 deviations of both coordinates.
double tolerance_px_s(int tracks, double sigma_px = kSigma_px) {
  return 5 * 1.1 * sigma_px * std::sqrt(2.0 / (tracks / 2.0)) / kFrame_s;
}

TEST(Objects, OneIsFoundFromTheSecondFrameOn) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    World world(seed);
    world.things.emplace_back(world.source, 20, 40, 100000);
    Thing& ball = world.things[0];
    ball.middle_px = {-150, 20};
    ball.moved_px = {9, -3};
    EXPECT_TRUE(world.step().empty());
    std::set<uint32_t> ids;
    for (int n = 0; n < 20; ++n) {
      const auto& found = world.step();
      ASSERT_EQ(found.size(), 1u) << "seed " << seed << ", frame " << n;
      ids.insert(found[0].id);
      EXPECT_EQ(found[0].model, ModelKind::kTranslation);
      EXPECT_LT((found[0].relative_px_s * kFrame_s - ball.moved_px).norm() / kFrame_s,
                tolerance_px_s(20))
          << "seed " << seed << ", frame " << n;
      EXPECT_EQ(found[0].relative_px_s, found[0].on_screen_px_s);
      // The mean of 20 places in a disc of 40 px, all of which may be on one side by chance: a
      // place is off by 40/2 px rms in each coordinate, its mean by 20/√20.
      EXPECT_LT((found[0].position_px - ball.middle_px).norm(), 4 * 20 / std::sqrt(20.0) * 1.5);
      EXPECT_LE(found[0].size_px.maxCoeff(), 80 + 1);
      EXPECT_GE(found[0].size_px.minCoeff(), 40);
    }
    EXPECT_EQ(ids.size(), 1u) << "seed " << seed;
  }
}

TEST(Objects, VelocityIsAgainstTheBackgroundAndOnTheScreen) {
  for (const ModelKind kind : {ModelKind::kTranslation, ModelKind::kSimilarity, ModelKind::kAffine,
                               ModelKind::kHomography}) {
    World world(11);
    world.camera = sample_model(kind);
    // Small: 8 of 158 tracks.
    world.things.emplace_back(world.source, 8, 20, 100000);
    Thing& ball = world.things[0];
    ball.middle_px = {-60, 20};
    ball.moved_px = {6, 2};
    for (int n = 0; n < 12; ++n) {
      const Eigen::Vector2d behind_px = world.camera.displacement_px(ball.middle_px);
      const auto& found = world.step();
      if (n == 0) continue;
      ASSERT_EQ(found.size(), 1u) << to_string(kind) << ", frame " << n;
      const Eigen::Vector2d relative_px_s = (ball.moved_px - behind_px) / kFrame_s;
      // The background is taken at the middle of the tracks, not of the ball: up to 20/√8 · 3 px
      // apart, times at most 4 % of linear part.
      const double place_px_s = 0.04 * 20 / std::sqrt(8.0) * 3 / kFrame_s;
      EXPECT_LT((found[0].relative_px_s - relative_px_s).norm(), tolerance_px_s(8) + place_px_s)
          << to_string(kind) << ", frame " << n;
      EXPECT_LT((found[0].on_screen_px_s - ball.moved_px / kFrame_s).norm(), tolerance_px_s(8));
    }
  }
}

TEST(Objects, NothingWhereOnlyTheCameraMoves) {
  for (const ModelKind kind : {ModelKind::kStill, ModelKind::kTranslation, ModelKind::kSimilarity,
                               ModelKind::kAffine, ModelKind::kHomography}) {
    for (uint32_t seed = 1; seed <= 5; ++seed) {
      World world(seed);
      world.camera = sample_model(kind);
      for (int n = 0; n < 20; ++n) {
        ASSERT_TRUE(world.step().empty())
            << to_string(kind) << ", seed " << seed << ", frame " << n;
      }
    }
  }
}

TEST(Objects, NothingWhereThereIsOnlyNoiseHoweverStrong) {
  for (const double noise_px : {0.1, 0.3, 0.6, 1.0, 3.0}) {
    for (uint32_t seed = 1; seed <= 10; ++seed) {
      World world(seed);
      world.noise_px = noise_px;
      for (int n = 0; n < 30; ++n) {
        ASSERT_TRUE(world.step().empty()) << noise_px << " px, seed " << seed << ", frame " << n;
      }
    }
  }
}

TEST(Objects, OneOnAPlainBackgroundIsAnObject) {
  World world(3);
  world.textured = false;
  world.things.emplace_back(world.source, 100, 60, 100000);
  world.things[0].moved_px = {-4, 7};
  world.step();
  for (int n = 0; n < 10; ++n) {
    const auto& found = world.step();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_LT((found[0].relative_px_s * kFrame_s - Eigen::Vector2d(-4, 7)).norm() / kFrame_s,
              tolerance_px_s(100));
  }
}

TEST(Objects, TwoThatCrossKeepTheirIdentity) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    World world(seed);
    world.things.emplace_back(world.source, 20, 30, 100000);
    world.things.emplace_back(world.source, 20, 30, 200000);
    Thing& front = world.things[0];
    Thing& back = world.things[1];
    front.middle_px = {-100, 0};
    front.moved_px = {8, 0};
    back.middle_px = {100, 5};
    back.moved_px = {-8, 1};
    uint32_t front_id = 0, back_id = 0, track_id = 300000;
    for (int n = 0; n < 26; ++n) {
      // Behind the other one its tracks are lost; the tracker gives new ones afterwards.
      const bool hidden = (front.middle_px - back.middle_px).norm() < 25;
      if (back.hidden && !hidden) back.first_id = track_id;
      back.hidden = hidden;
      const auto found = world.step();
      if (n == 1) {
        ASSERT_EQ(found.size(), 2u) << "seed " << seed;
        const bool first_is_front = found[0].relative_px_s.x() > 0;
        front_id = found[first_is_front ? 0 : 1].id;
        back_id = found[first_is_front ? 1 : 0].id;
      }
      if (n < 2) continue;
      ASSERT_EQ(found.size(), 2u) << "seed " << seed << ", frame " << n;
      for (const MovingObject& object : found) {
        if (object.tracks == 0) continue;
        EXPECT_EQ(object.id, object.relative_px_s.x() > 0 ? front_id : back_id)
            << "seed " << seed << ", frame " << n;
      }
    }
  }
}

TEST(Objects, StaysTheSameThroughAShortOcclusion) {
  World world(5);
  world.things.emplace_back(world.source, 15, 25, 100000);
  Thing& ball = world.things[0];
  ball.middle_px = {-200, 0};
  ball.moved_px = {8, 1};
  for (int n = 0; n < 5; ++n) world.step();
  const uint32_t id = world.objects.update({}, {}, kWidth, kHeight, kFrame_s).at(0).id;
  ball.middle_px += ball.moved_px;
  ball.hidden = true;
  for (int n = 0; n < 7; ++n) {
    const auto& found = world.step();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].id, id);
    EXPECT_EQ(found[0].tracks, 0);
  }
  // Not seen for a tenth of a second: not felt.
  EXPECT_EQ(world.step()[0].relative_px_s, Eigen::Vector2d::Zero());
  ball.hidden = false;
  ball.first_id += 500;
  const auto& found = world.step();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, id);
  EXPECT_GT(found[0].tracks, 10);
}

TEST(Objects, DiesWhenItIsGone) {
  World world(6);
  world.things.emplace_back(world.source, 15, 25, 100000);
  world.things[0].moved_px = {8, 1};
  for (int n = 0; n < 5; ++n) world.step();
  world.things[0].hidden = true;
  const int frames = static_cast<int>(ObjectTracker::kForgotten_s / kFrame_s) + 1;
  for (int n = 0; n < frames; ++n) world.step();
  EXPECT_TRUE(world.step().empty());
}

TEST(Objects, MayStandStillForAMomentAndThenDies) {
  World world(7);
  world.things.emplace_back(world.source, 15, 25, 100000);
  Thing& ball = world.things[0];
  ball.moved_px = {8, 1};
  for (int n = 0; n < 5; ++n) world.step();
  const uint32_t id = world.step().at(0).id;
  ball.moved_px = {0, 0};
  for (int n = 0; n < 10; ++n) {
    ASSERT_EQ(world.step().size(), 1u);
    EXPECT_LT(world.step().at(0).relative_px_s.norm(), tolerance_px_s(15));
  }
  ball.moved_px = {-5, 0};
  EXPECT_EQ(world.step().at(0).id, id);
  ball.moved_px = {0, 0};
  const int frames = static_cast<int>(ObjectTracker::kAtRest_s / kFrame_s) + 2;
  for (int n = 0; n < frames; ++n) world.step();
  EXPECT_TRUE(world.step().empty());
}

TEST(Objects, TurnAndGrowthAreSeenBeyondNoise) {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    World world(seed);
    world.things.emplace_back(world.source, 30, 50, 100000);
    Thing& wheel = world.things[0];
    wheel.middle_px = {-80, 10};
    wheel.moved_px = {5, 0};
    wheel.turn_rad = 0.04;
    wheel.grow = 0.02;
    world.step();
    for (int n = 0; n < 10; ++n) {
      const auto& found = world.step();
      ASSERT_EQ(found.size(), 1u) << "seed " << seed << ", frame " << n;
      EXPECT_EQ(found[0].model, ModelKind::kSimilarity);
      // σ / √(Σ r²), r of 30 points in a disc of 50 px is 35 px rms, half of them used at worst; 5
      // deviations.
      const double tolerance = 5 * kSigma_px / (35 * std::sqrt(15.0));
      EXPECT_NEAR(found[0].roll_rad_s * kFrame_s, 0.04, tolerance);
      EXPECT_NEAR(found[0].growth_1_s * kFrame_s, 1.02 * std::cos(0.04) - 1, tolerance);
    }
  }
}

TEST(Objects, AWheelThatTurnsInPlaceIsAnObject) {
  World world(8);
  world.things.emplace_back(world.source, 30, 50, 100000);
  world.things[0].turn_rad = 0.05;
  world.step();
  for (int n = 0; n < 10; ++n) {
    const auto& found = world.step();
    ASSERT_EQ(found.size(), 1u) << n;
    EXPECT_NEAR(found[0].roll_rad_s * kFrame_s, 0.05, 5 * kSigma_px / (35 * std::sqrt(15.0)));
  }
}

TEST(Objects, AreTheSameBitForBit) {
  const auto run = [] {
    World world(9);
    world.camera = sample_model(ModelKind::kSimilarity);
    world.things.emplace_back(world.source, 30, 50, 100000);
    world.things.emplace_back(world.source, 10, 20, 200000);
    world.things[0].moved_px = {9, 4};
    world.things[1].middle_px = {150, 60};
    world.things[1].moved_px = {-9, 4};
    std::vector<double> numbers;
    for (int n = 0; n < 10; ++n) {
      for (const MovingObject& object : world.step()) {
        numbers.push_back(object.relative_px_s.x());
        numbers.push_back(object.position_px.y());
        numbers.push_back(object.prominence);
      }
    }
    return numbers;
  };
  EXPECT_EQ(run(), run());
  EXPECT_GT(run().size(), 30u);
}

}  // namespace
}  // namespace spidar
