// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What tells an object from a layer of the scene, and how much it stands out.
#include <cmath>

#include <gtest/gtest.h>

#include "core/motion/layers/salience.h"

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

/// A second of constant motion, of which the first 0.3 s have no influence left: 0.96^25 < e^-3 /
/// 10 of it, below the tolerances here.
LayerEvidence evidence_of(const Eigen::Vector2d& relative_px,
                          const Eigen::Vector2d& background_px) {
  constexpr int kFrames = 25;
  constexpr double kFrame_s = 1.0 / kFrames;
  LayerEvidence evidence;
  for (int n = 0; n < kFrames; ++n) {
    evidence.add(relative_px / kFrame_s, background_px / kFrame_s, kFrame_s);
  }
  return evidence;
}

const LayerEvidence kNoEvidence;

TEST(LayerEvidence, IsSpeedOnTheScreenOverSpeedAgainstTheBackground) {
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {0, 0}).ratio(), 1) << "the camera rests";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {-3, 0}).ratio(), 0) << "the camera follows it";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {6, 0}).ratio(), 3) << "a layer";
  EXPECT_DOUBLE_EQ(evidence_of({3, 0}, {0, 4}).ratio(), 5.0 / 3);
  EXPECT_GT(evidence_of({0, 0}, {1, 0}).ratio(), 1000) << "a part of the background";
  EXPECT_EQ(kNoEvidence.ratio(), 0);
}

TEST(LayerEvidence, AnObjectThatTurnsIntoTheBackgroundsDirectionRemainsOne) {
  constexpr double kFrame_s = 0.04;
  LayerEvidence evidence;
  for (int n = 0; n < 25; ++n) evidence.add({-10, 0}, {10, 0}, kFrame_s);
  for (int n = 0; n < 25; ++n) evidence.add({10, 0}, {10, 0}, kFrame_s);
  EXPECT_NEAR(evidence.ratio(), 0, 1e-9) << "no layer moves both ways";
}

TEST(LayerEvidence, ACameraThatShakesInPlaceSaysNothing) {
  constexpr double kFrame_s = 0.04;
  LayerEvidence evidence;
  // At 6.25 Hz, two swings in the time constant: what is left of them in the mean is below
  // 1 / √(1 + (2π · 6.25 · 0.3)²) = 0.085 of their size, 5 times the object's speed.
  for (int n = 0; n < 50; ++n) {
    const double swing = 5 * std::sin(n * kFrame_s * 6.25 * 2 * M_PI);
    evidence.add({10, 0}, {10 * swing, 0}, kFrame_s);
  }
  EXPECT_NEAR(evidence.ratio(), 1, 5 * 0.085);
}

TEST(Salience, IsSpeedTimesTheRootOfTheArea) {
  const CameraMotion still{false};
  EXPECT_DOUBLE_EQ(salience(region(16, 0, 3), kNoEvidence, still, false),
                   2 * salience(region(4, 0, 3), kNoEvidence, still, false));
  EXPECT_DOUBLE_EQ(salience(region(8, 0, 3), kNoEvidence, still, false),
                   3 * salience(region(8, 0, 1), kNoEvidence, still, false));
}

/// As evidence_of(), while the blocks around deviate by `noise_px`.
LayerEvidence evidence_in_noise(double moved_px, double noise_px,
                                LayerEvidence evidence = kNoEvidence) {
  evidence.add_contrast(moved_px, noise_px, 0.04);
  return evidence;
}

TEST(Salience, WhatStandsOutNowAndThenOnlyIsALayer) {
  const CameraMotion moving{true, 100};
  LayerEvidence layer = evidence_in_noise(2, 1);
  LayerEvidence object = evidence_in_noise(12, 1);
  // Every fifth frame differs. In the frames after 0.3 s, the mean square of the layer is at most
  // 47, which is 0.133 · 169 + 0.867 · (4 + 0.867⁴ · (47 − 4)), and that of the object at least
  // 107.
  for (int n = 1; n <= 25; ++n) {
    layer = evidence_in_noise(n % 5 == 0 ? 13 : 2, 1, layer);
    object = evidence_in_noise(n % 5 == 0 ? 2 : 12, 1, object);
    EXPECT_EQ(salience(region(25, 0, 10), layer, moving, false), 0) << n;
    EXPECT_GT(salience(region(25, 0, 2), object, moving, false), 0) << n;
  }
}

TEST(Salience, AnotherLayerAsLargeAsTheBackgroundHasNoneWhileTheCameraMoves) {
  const CameraMotion still{false, 40};
  const CameraMotion moving{true, 40};
  const LayerEvidence layer = evidence_of({4, 0}, {2, 0});
  EXPECT_GT(salience(region(20, 0, 4), layer, moving, false), 0) << "half of it";
  EXPECT_EQ(salience(region(21, 0, 4), layer, moving, false), 0);
  EXPECT_EQ(salience(region(21, 0, 4), layer, moving, true), 0);
  EXPECT_GT(salience(region(21, 0, 4), evidence_of({4, 0}, {-4, 0}), moving, false), 0)
      << "it goes against the background: the camera follows it";
  EXPECT_GT(salience(region(21, 0, 4), evidence_of({4, 0}, {0, 0}), still, false), 0);
}

TEST(Salience, WhatLeansOnTheBorderHasNoneWhileTheCameraMoves) {
  const CameraMotion still{false};
  const CameraMotion moving{true, 100};
  const Region layer = region(25, 12, 5);
  EXPECT_GT(salience(layer, kNoEvidence, still, false), 0);
  EXPECT_EQ(salience(layer, kNoEvidence, moving, false), 0);
  EXPECT_GT(salience(region(25, 2, 5), kNoEvidence, moving, false), 0);
  EXPECT_EQ(salience(region(25, 8, 5), kNoEvidence, moving, false), 0);
  EXPECT_GT(salience(region(25, 8, 5), kNoEvidence, moving, true), 0)
      << "an object that leaves the picture";
}

TEST(Salience, ALayerThatMovesWithTheBackgroundIsNoObject) {
  const CameraMotion moving{true, 100};
  const Region slow = region(25, 0, 1.8);
  EXPECT_GT(salience(slow, evidence_of({9, 0}, {-10, 0}), moving, false), 0) << "it is followed";
  EXPECT_EQ(salience(slow, evidence_of({1.8, 0}, {10, 0}), moving, false), 0) << "a near layer";
  EXPECT_EQ(salience(slow, evidence_of({1.8, 0}, {0, 10}), moving, false), 0);
  EXPECT_GT(salience(slow, evidence_of({1.8, 0}, {1.8, 0}), moving, true), 0)
      << "an object may look a little like a layer";
}

TEST(Salience, WhatDiffersLikeTheSceneItselfHasNone) {
  const CameraMotion moving{true, 100};
  const Region one = region(25, 0, 3);
  const LayerEvidence weak = evidence_in_noise(3.9, 0.5);  // less than 8 standard deviations
  EXPECT_EQ(salience(one, weak, moving, false), 0);
  EXPECT_GT(salience(one, weak, moving, true), 0) << "an object that slows down";
  EXPECT_GT(salience(one, evidence_in_noise(4.1, 0.5), moving, false), 0) << "more than 8";
  EXPECT_EQ(
      salience(one, evidence_in_noise(4.1, 0.5, evidence_of({1, 0}, {0.3, 0})), moving, false), 0)
      << "as much, but more like a layer";
  EXPECT_GT(salience(one, weak, {false}, false), 0) << "no camera moves";
}

TEST(Salience, WhatMostlyAdjoinsGraphicsHasNoneWhileTheCameraMoves) {
  const CameraMotion still{false, 100};
  const CameraMotion moving{true, 100};
  Region edge = region(10, 0, 5);
  edge.graphics_blocks = 4;
  EXPECT_GT(salience(edge, kNoEvidence, moving, false), 0) << "an object that appears beside them";
  edge.graphics_blocks = 5;
  EXPECT_EQ(salience(edge, kNoEvidence, moving, false), 0);
  EXPECT_GT(salience(edge, kNoEvidence, moving, true), 0) << "an object that passes by";
  edge.graphics_blocks = 7;
  EXPECT_EQ(salience(edge, kNoEvidence, moving, true), 0);
  EXPECT_GT(salience(edge, kNoEvidence, still, false), 0) << "graphics rest with the scene";
}

TEST(Salience, ASingleEdgeHasNone) {
  Region edge = region(10, 0, 5);
  edge.roundness = 0;
  EXPECT_EQ(salience(edge, kNoEvidence, {false}, false), 0);
}

}  // namespace
}  // namespace spidar::test::salience_test
