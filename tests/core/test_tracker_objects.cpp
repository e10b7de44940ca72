// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The tracker with objects that enter the picture, and with noise.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/core/moving_texture.h"
#include "tests/support/ball_scene.h"

namespace spidar::test::tracker_objects_test {
namespace {

/// Tracks that begin on the ball and follow it.
int on_ball(const TrackedFrame& frame, const BallScene& scene, double t0_s, double t1_s) {
  const Eigen::Vector2d centre = scene.position_px(t0_s);
  const Eigen::Vector2d moved = scene.position_px(t1_s) - centre;
  return static_cast<int>(
      std::count_if(frame.tracks.begin(), frame.tracks.end(), [&](const Track& t) {
        const Eigen::Vector2d from(static_cast<double>(t.from.x_px),
                                   static_cast<double>(t.from.y_px));
        return (from - centre).norm() < scene.settings().radius_px &&
               (Eigen::Vector2d(dx(t), dy(t)) - moved).norm() < 2 * kTrackTolerance_px;
      }));
}

/// The most tracks on a ball that has just come in from the left.
int found_on_entering_ball(uint32_t seed, bool textured_background) {
  BallSettings settings;
  settings.seed = seed;
  settings.textured_background = textured_background;
  settings.radius_px = 70;
  settings.start_px = {-160, 180};
  settings.horizontal_px_s = 240;
  settings.floor_px = 251;
  const BallScene scene(settings);
  Picture picture(settings.width, settings.height);
  OpenCvTracker tracker;
  constexpr double kFrame_s = 1.0 / 30;
  int most = 0;
  // The ball is wholly inside after 230 px, 29 frames. Points are selected every 5 frames at the
  // latest, and followed from the next on.
  for (int n = 0; n <= 29 + 6; ++n) {
    scene.render(n * kFrame_s, picture.pixels.data(), picture.stride);
    const TrackedFrame& frame = tracker.track(picture.view());
    if (n > 0) most = std::max(most, on_ball(frame, scene, (n - 1) * kFrame_s, n * kFrame_s));
  }
  return most;
}

TEST(OpenCvTracker, AnObjectThatEntersAnEmptyPictureIsFound) {
  // A disc of 70 px has room for some hundred points 7.5 px apart: half of them at least.
  EXPECT_GE(found_on_entering_ball(1, false), 50);
}

TEST(OpenCvTracker, AnObjectThatEntersAFullPictureGetsItsShareOfThePoints) {
  // All 200 points are taken when it comes. Away from its edge it covers 60² π of 626 × 346 px, 5.2
  // % or 10 points if all textures were equally strong: half of that on average over six textures,
  // and at least one on the weakest.
  int sum = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const int found = found_on_entering_ball(seed, true);
    EXPECT_GE(found, 1) << "seed " << seed;
    sum += found;
  }
  EXPECT_GE(sum, 6 * 5);
}

TEST(OpenCvTracker, IndependentNoiseIsNotMotion) {
  std::mt19937 random(17);
  for (const double sigma : {2.0, 8.0, 30.0}) {
    std::normal_distribution<double> noise(128, sigma);
    Picture picture(640, 360);
    OpenCvTracker tracker;
    int looked_for = 0;
    for (int n = 0; n < 12; ++n) {
      picture.fill([&](double, double) { return std::min(255.0, std::max(0.0, noise(random))); });
      const TrackedFrame& frame = tracker.track(picture.view());
      // What is found again by chance is less than what makes a cut.
      EXPECT_TRUE(frame.tracks.size() * 10 <= static_cast<size_t>(looked_for))
          << "seed 17, sigma " << sigma << ", frame " << n << ": " << frame.tracks.size() << " of "
          << looked_for;
      looked_for = frame.features;
    }
  }
}

}  // namespace
}  // namespace spidar::test::tracker_objects_test
