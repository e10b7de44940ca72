// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/dominant_object.h"

namespace spidar::test::dominant_object_test {
namespace {

/// A fifth of kMean_s: a frame is 0.2 of a mean, and 0.8 of it is from before.
constexpr double kFrame_s = 0.04;

MovingObject object(uint32_t id, double prominence) {
  MovingObject made;
  made.id = id;
  made.prominence = prominence;
  return made;
}

/// The id of the object that is chosen, 0 for none, after `frames` frames with `objects`.
uint32_t choice(DominantObject& dominant, const std::vector<MovingObject>& objects, int frames = 1,
                double interval_s = kFrame_s) {
  const MovingObject* chosen = nullptr;
  for (int n = 0; n < frames; ++n) chosen = dominant.choose(objects, interval_s);
  return chosen ? chosen->id : 0;
}

constexpr int kLong = 100;  // frames: a mean no longer changes, 0.8^100 < 1e-9

TEST(DominantObject, IsTheMostProminentOneToBeginWith) {
  DominantObject dominant;
  EXPECT_EQ(choice(dominant, {}), 0u);
  EXPECT_EQ(choice(dominant, {object(1, 5), object(2, 9), object(3, 7)}), 2u);
}

TEST(DominantObject, StaysWhenAnotherIsALittleMoreProminent) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)});
  for (int n = 0; n < kLong; ++n) {
    ASSERT_EQ(choice(dominant, {object(1, 10), object(2, 19)}), 1u) << n;
  }
}

TEST(DominantObject, StaysWhenAnotherStandsOutInAFewFramesOnly) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  // The mean rises from 9 to 9 + 0.2 · 41 = 17.2, less than twice 10, and falls back.
  for (int n = 0; n < kLong; ++n) {
    ASSERT_EQ(choice(dominant, {object(1, 10), object(2, 50)}), 1u) << n;
    ASSERT_EQ(choice(dominant, {object(1, 10), object(2, 9)}, kLong), 1u) << n;
  }
}

TEST(DominantObject, GoesToOneThatIsClearlyMoreProminentForLongEnough) {
  // 40 − 35 exp(−t / kMean_s) = 2 · 10, at any frame rate; seen in the next frame.
  const double after_s = DominantObject::kMean_s * std::log(35.0 / 20);
  for (const double interval_s : {0.01, 0.02, 0.04}) {
    DominantObject dominant;
    choice(dominant, {object(1, 10), object(2, 5)}, 10 * kLong, interval_s);
    const std::vector<MovingObject> outshone = {object(1, 10), object(2, 40)};
    int frames = 1;
    while (choice(dominant, outshone, 1, interval_s) == 1 && frames < kLong) ++frames;
    EXPECT_NEAR(frames * interval_s, after_s, interval_s);
    // And does not come back for less.
    EXPECT_EQ(choice(dominant, {object(1, 79), object(2, 40)}, kLong, interval_s), 2u);
  }
}

TEST(DominantObject, StaysWithOneThatIsMissingInAFewFrames) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  // At rest or out of sight, and taken for a layer of the scene.
  for (const auto& without : {std::vector<MovingObject>{object(1, 0), object(2, 9)},
                              std::vector<MovingObject>{object(2, 9)}}) {
    // 2 · 10 · 0.8³ = 10.2 > 9.
    EXPECT_NE(choice(dominant, without, 3), 2u);
    EXPECT_EQ(choice(dominant, {object(1, 10), object(2, 9)}, kLong), 1u);
  }
}

TEST(DominantObject, LeavesOneThatIsGone) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  // 2 · 10 · 0.8⁴ = 8.2 < 9.
  EXPECT_EQ(choice(dominant, {object(2, 9)}, 3), 0u);
  EXPECT_EQ(choice(dominant, {object(2, 9)}), 2u);
  EXPECT_EQ(choice(dominant, {}, kLong), 0u);
}

TEST(DominantObject, DoesNotGoToOneThatRests) {
  DominantObject dominant;
  choice(dominant, {object(1, 10), object(2, 9)}, kLong);
  EXPECT_EQ(choice(dominant, {object(2, 0)}, kLong), 0u);
}

TEST(DominantObject, ALoneOneIsFollowedAtOnce) {
  DominantObject dominant;
  EXPECT_EQ(choice(dominant, {object(1, 10)}), 1u);
  // Half a second later nothing is left of it: 2 · 10 · 0.8¹³ = 1.1 < 0.2 · 10.
  EXPECT_EQ(choice(dominant, {}, 12), 0u);
  EXPECT_EQ(choice(dominant, {object(2, 10)}), 2u);
  dominant.reset();
  EXPECT_EQ(choice(dominant, {object(3, 1)}), 3u);
}

}  // namespace
}  // namespace spidar::test::dominant_object_test
