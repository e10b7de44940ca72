// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What tells an object from a layer of the scene, and how much it stands out.
#include "core/motion/layers/regions.h"
#include "tests/support/test.h"

namespace spidar::test::salience_test {
namespace {

Region region(int blocks, int border_blocks, double speed_px) {
  Region made;
  made.blocks = blocks;
  made.border_blocks = border_blocks;
  made.relative_px << speed_px, 0;
  made.roundness = 1;
  return made;
}

/// A second of constant motion, in px a frame.
LayerEvidence evidence_of(const Eigen::Vector2d& relative_px, const Eigen::Vector2d& background_px,
                          double noise_px = 0) {
  constexpr int kFrames = 25;
  LayerEvidence evidence;
  for (int n = 0; n < kFrames; ++n) {
    evidence.add(relative_px, background_px, noise_px, 1.0 / kFrames);
  }
  return evidence;
}

const LayerEvidence kFollowed = evidence_of({3, 0}, {-3, 0});

constexpr bool kCameraMoves = true;
constexpr bool kCameraRests = false;

TEST(LayerEvidence, IsSpeedOnTheScreenOverSpeedAgainstTheBackground) {
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {0, 0}).ratio(), 1) << "the camera rests";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {-3, 0}).ratio(), 0) << "the camera follows it";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {6, 0}).ratio(), 3) << "a layer";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {0, 4}).ratio(), 5.0 / 3);
  EXPECT_GT(evidence_of({0, 0}, {1, 0}).ratio(), 1000) << "a part of the background";
}

constexpr double kFrame_s = 0.04;

TEST(LayerEvidence, ACameraThatShakesInPlaceSaysNothing) {
  LayerEvidence evidence;
  // At 6.25 Hz, nearly four swings in the time constant: what is left of them in the mean is below
  // 1 / √(1 + (2π · 6.25 · 0.6)²) = 0.043 of their size, 5 times the object's speed.
  for (int n = 0; n < 50; ++n) {
    const double swing = 5 * std::sin(n * kFrame_s * 6.25 * 2 * M_PI);
    evidence.add({10, 0}, {10 * swing, 0}, 0, kFrame_s);
  }
  EXPECT_NEAR(evidence.ratio(), 1, 5 * 0.043);
}

TEST(LayerEvidence, WhatGoesBackAndForthIsNoLayerOfASteadyPan) {
  LayerEvidence evidence;
  // At 2 Hz, 1 / √(1 + (2π · 2 · 0.6)²) = 0.13 of its 10 px are left in the mean, beside the 4 px
  // of the pan; and of its mean square, 50 px², 1 / √(1 + (2π · 4 · 0.6)²) = 0.066 swings.
  for (int n = 0; n < 100; ++n) {
    const double there_px = 10 * std::sin(n * kFrame_s * 2 * 2 * M_PI);
    evidence.add({there_px, 0}, {4, 0}, 0, kFrame_s);
    if (n < 50) continue;  // by then 0.96^50 of the beginning is left
    EXPECT_LT(evidence.ratio(), (4 + 0.13 * 10) / std::sqrt(50 * (1 - 0.066))) << n;
  }
}

TEST(Salience, IsSpeedTimesTheRootOfTheArea) {
  EXPECT_DOUBLE_EQ(salience(region(16, 0, 3), kFollowed, kCameraRests, false),
                   2 * salience(region(4, 0, 3), kFollowed, kCameraRests, false));
  EXPECT_DOUBLE_EQ(salience(region(8, 0, 3), kFollowed, kCameraRests, false),
                   3 * salience(region(8, 0, 1), kFollowed, kCameraRests, false));
}

TEST(Salience, WhatStandsOutNowAndThenOnlyIsALayer) {
  LayerEvidence layer;
  LayerEvidence object;
  // Every fifth frame differs, and has a weight of 1/15. The mean square of the layer is at most
  // 42, which is 169 / 15 + 14/15 · (4 + (14/15)⁴ · (42 − 4)), and that of the object at least 112.
  for (int n = 0; n <= 25; ++n) {
    layer.add({n % 5 == 4 ? 13.0 : 2, 0}, {0, 0}, 1, 0.04);
    object.add({n % 5 == 4 ? 2.0 : 12, 0}, {0, 0}, 1, 0.04);
    EXPECT_EQ(salience(region(25, 0, 10), layer, kCameraMoves, false), 0) << n;
    EXPECT_GT(salience(region(25, 0, 2), object, kCameraMoves, false), 0) << n;
  }
}

TEST(Salience, WhatLeansOnTheBorderHasNoneWhileTheCameraMoves) {
  const Region layer = region(25, 12, 5);
  EXPECT_GT(salience(layer, kFollowed, kCameraRests, false), 0);
  EXPECT_EQ(salience(layer, kFollowed, kCameraMoves, false), 0);
  EXPECT_GT(salience(region(25, 2, 5), kFollowed, kCameraMoves, false), 0);
  EXPECT_EQ(salience(region(25, 8, 5), kFollowed, kCameraMoves, false), 0);
  EXPECT_GT(salience(region(25, 8, 5), kFollowed, kCameraMoves, true), 0)
      << "an object that leaves the picture";
}

TEST(Salience, ALayerThatMovesWithTheBackgroundIsNoObject) {
  const Region slow = region(25, 0, 1.8);
  constexpr double kNoise_px = 0.1;
  EXPECT_GT(salience(slow, evidence_of({9, 0}, {-10, 0}, kNoise_px), kCameraMoves, false), 0)
      << "it is followed";
  EXPECT_EQ(salience(slow, evidence_of({1.8, 0}, {10, 0}, kNoise_px), kCameraMoves, false), 0)
      << "a near layer";
  EXPECT_EQ(salience(slow, evidence_of({1.8, 0}, {0, 10}, kNoise_px), kCameraMoves, false), 0);
  EXPECT_GT(salience(slow, evidence_of({1.8, 0}, {1.8, 0}, kNoise_px), kCameraMoves, true), 0)
      << "an object may look a little like a layer";
}

TEST(Salience, WhatDiffersLikeTheSceneItselfHasNone) {
  const Region one = region(25, 0, 3);
  const LayerEvidence weak = evidence_of({3.9, 0}, {0, 0}, 0.5);  // less than 8 standard deviations
  EXPECT_EQ(salience(one, weak, kCameraMoves, false), 0);
  EXPECT_GT(salience(one, weak, kCameraMoves, true), 0) << "an object that slows down";
  EXPECT_GT(salience(one, evidence_of({4.1, 0}, {0, 0}, 0.5), kCameraMoves, false), 0)
      << "more than 8";
  EXPECT_EQ(salience(one, evidence_of({4.1, 0}, {1.3, 0}, 0.5), kCameraMoves, false), 0)
      << "as much, but more like a layer";
  EXPECT_GT(salience(one, weak, kCameraRests, false), 0) << "no camera moves";
}

TEST(Salience, WhatMostlyAdjoinsGraphicsHasNoneWhileTheCameraMoves) {
  Region edge = region(10, 0, 5);
  edge.graphics_blocks = 4;
  EXPECT_GT(salience(edge, kFollowed, kCameraMoves, false), 0)
      << "an object that appears beside them";
  edge.graphics_blocks = 5;
  EXPECT_EQ(salience(edge, kFollowed, kCameraMoves, false), 0);
  EXPECT_GT(salience(edge, kFollowed, kCameraMoves, true), 0) << "an object that passes by";
  edge.graphics_blocks = 7;
  EXPECT_EQ(salience(edge, kFollowed, kCameraMoves, true), 0);
  EXPECT_GT(salience(edge, kFollowed, kCameraRests, false), 0) << "graphics rest with the scene";
}

TEST(Salience, ASingleEdgeHasNone) {
  Region edge = region(10, 0, 5);
  edge.roundness = 0;
  EXPECT_EQ(salience(edge, kFollowed, kCameraRests, false), 0);
}

}  // namespace
}  // namespace spidar::test::salience_test
