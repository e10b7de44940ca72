// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames from which no motion can be determined: points and field report exactly none.
#include "core/motion/motion_estimator.h"
#include "core/points/tracker.h"
#include "tests/support/motion_cases.h"
#include "tests/support/test.h"

namespace spidar::test::hard_frames_test {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr int kFrames = 8;  // light steps and cuts come at the sixth
constexpr int64_t kFrame_ns = 40'000'000;

/// Runs films of this name, and reports any motion that is felt.
class HardFrames : public testing::TestWithParam<const char*> {};

TEST_P(HardFrames, ShowNoMotion) {
  for (const uint32_t seed : {1u, 2u}) {
    SCOPED_TRACE("picture " + std::to_string(seed));
    test::Film film = test::motion_case(GetParam(), kWidth, kHeight, seed);
    OpenCvTracker tracker;
    MotionEstimator estimator;
    ReducedFrame reduced;
    for (int n = 0; n < kFrames; ++n) {
      const ImageView frame = film.draw(n);
      const OpenCvTracker::Result& tracked = tracker.track(frame);
      reduced.read(frame);
      MeasuredFrame scene;
      scene.interval_ns = kFrame_ns;
      const bool is_compared = estimator.estimate(frame, reduced, scene);
      if (tracked.picture == FrameComparison::kFirst) {
        EXPECT_TRUE(tracked.points.empty()) << "frame " << n;
      }
      const ImageMotion mean = mean_motion(tracked.points, kFrame_ns);
      EXPECT_EQ(mean.velocity_px_s, Eigen::Vector2d(0, 0)) << "frame " << n;
      if (!is_compared) continue;
      EXPECT_EQ(scene.background->model.shift_px, Eigen::Vector2d(0, 0)) << "frame " << n;
      EXPECT_TRUE(scene.objects.empty()) << "frame " << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Films, HardFrames,
                         testing::Values("still", "flat", "noise-only", "single-edge", "light-step",
                                         "cut"));

}  // namespace
}  // namespace spidar::test::hard_frames_test
