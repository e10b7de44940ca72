// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames from which no motion can be determined: every tracker reports exactly none.
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/motion_estimator.h"
#include "core/tracking/opencv_tracker.h"
#include "core/tracking/patch_tracker.h"
#include "tests/support/motion_cases.h"

namespace spidar {
namespace {

struct NamedTracker {
  std::string name;
  std::function<std::unique_ptr<Tracker>()> make;
};
std::ostream& operator<<(std::ostream& out, const NamedTracker& kind) {
  return out << kind.name;
}

/// Add a tracker here.
const std::vector<NamedTracker> kTrackers = {
    {"opencv", [] { return std::make_unique<OpenCvTracker>(); }},
    {"patch", [] { return std::make_unique<PatchTracker>(); }},
};

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr int kFrames = 8;  // light steps and cuts come at the sixth
constexpr int64_t kFrame_ns = 40'000'000;

class HardFrames : public testing::TestWithParam<NamedTracker> {
 protected:
  /// Runs a film, and reports any motion that is felt.
  static void expect_nothing(const std::string& name) {
    for (const uint32_t seed : {1u, 2u}) {
      SCOPED_TRACE(name + ", picture " + std::to_string(seed));
      test::Film film = test::motion_case(name).film(kWidth, kHeight, seed);
      const std::unique_ptr<Tracker> tracker = GetParam().make();
      MotionEstimator estimator;
      ReducedFrame reduced;
      for (int n = 0; n < kFrames; ++n) {
        const ImageView frame = film.draw(n);
        const TrackedFrame& tracked = tracker->track(frame);
        reduced.read(frame);
        const SceneMotion scene =
            estimator.estimate(MotionKind::kObject, frame, reduced, {&tracked, {}}, kFrame_ns);
        if (tracked.restarted) {
          EXPECT_TRUE(tracked.tracks.empty()) << "frame " << n;
        }
        const ImageMotion mean = mean_motion(tracked.tracks, kFrame_ns);
        EXPECT_EQ(mean.velocity_px_s, Eigen::Vector2d(0, 0)) << "frame " << n;
        EXPECT_EQ(scene.felt.velocity_px_s, Eigen::Vector2d(0, 0)) << "frame " << n;
        EXPECT_EQ(scene.camera.velocity_px_s, Eigen::Vector2d(0, 0)) << "frame " << n;
        EXPECT_EQ(scene.objects, 0) << "frame " << n;
      }
    }
  }
};

TEST_P(HardFrames, AStillPictureDoesNotMove) {
  expect_nothing("still");
}
TEST_P(HardFrames, AFlatPictureDoesNotMove) {
  expect_nothing("flat");
}
TEST_P(HardFrames, NoiseDoesNotMove) {
  expect_nothing("noise-only");
}
TEST_P(HardFrames, AnEdgeIsNoPointToFollow) {
  expect_nothing("single-edge");
}
TEST_P(HardFrames, LightIsNoMotion) {
  expect_nothing("light-step");
}
TEST_P(HardFrames, ACutIsNoMotion) {
  expect_nothing("cut");
}

INSTANTIATE_TEST_SUITE_P(Trackers, HardFrames, testing::ValuesIn(kTrackers),
                         [](const auto& tracker) { return tracker.param.name; });

}  // namespace
}  // namespace spidar
