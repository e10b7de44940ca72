// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The force of a motion comes at the time of that motion. A disc circles, so that its velocity
// turns, and its force is behind by an angle.
#include "tests/support/felt_film.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::force_lag_test {
namespace {

constexpr double kCircle_px = 40, kTurn_rad_s = 2 * M_PI;  // one a second
constexpr double kSpeed_px_s = kCircle_px * kTurn_rad_s;
/// Error of the displacement of an object between two pictures, as in test_bouncing_ball.cpp.
constexpr double kMean_px = 0.05;
/// From the first frames on there is nothing to learn: the filter is off.
constexpr size_t kBegin_ms = 1000, kEnd_ms = 2000;

/// Of the force behind the velocity, s.
double lag_s(int rate_Hz, int64_t ahead_ns) {
  MovingScene scene(320, 240);
  scene.add_disc(40);
  std::vector<Picture> pictures;
  std::vector<int64_t> times_ns;
  for (int n = 0; n <= rate_Hz * 9 / 4; ++n) {
    const double time_s = n / static_cast<double>(rate_Hz);
    const double angle = kTurn_rad_s * time_s;
    const Eigen::Vector2d at_px(std::cos(angle), std::sin(angle));  // y down
    const ImageView drawn = scene.draw({}, {{kCircle_px * at_px}});
    Picture picture(320, 240);
    picture.fill(
        [&](double x, double y) { return *drawn.at(static_cast<int>(x), static_cast<int>(y)); });
    pictures.push_back(std::move(picture));
    times_ns.push_back(std::llround(1e9 * time_s));
  }
  std::vector<ShownFrame> frames;
  for (size_t n = 0; n < pictures.size(); ++n) frames.push_back({times_ns[n], &pictures[n]});
  AnalyzerSettings settings;
  settings.filter.min_cutoff_Hz = 0;
  const std::vector<Eigen::Vector3d> force_N = feel(frames, ahead_ns, settings);
  double along_N = 0, behind_N = 0;
  for (size_t ms = kBegin_ms; ms < kEnd_ms; ++ms) {
    const double angle = kTurn_rad_s * 1e-3 * static_cast<double>(ms);
    const Eigen::Vector2d along(-std::sin(angle), -std::cos(angle));  // y up
    const Eigen::Vector2d behind(std::cos(angle), -std::sin(angle));
    along_N += along.dot(force_N[ms].head<2>());
    behind_N += behind.dot(force_N[ms].head<2>());
  }
  EXPECT_GT(along_N / (kEnd_ms - kBegin_ms), 0.1) << "nothing is felt";
  return std::atan2(behind_N, along_N) / kTurn_rad_s;
}

/// An error of the velocity at a right angle to it, the same in all frames, turns it by its ratio
/// to the speed.
double error_s(int rate_Hz) {
  return kMean_px * rate_Hz / kSpeed_px_s / kTurn_rad_s;
}

TEST(ForceLag, IsNoneWhereFramesAreKnownAhead) {
  for (const int rate_Hz : {24, 30, 60}) {
    EXPECT_NEAR(lag_s(rate_Hz, 150'000'000), 0, error_s(rate_Hz)) << rate_Hz;
  }
}

/// Live, a frame is known when it is due, half an interval after its motion. Its force is reached
/// an approach later on a curve that is symmetric in time, and held until the next one: in the mean
/// it is there from half an approach after the frame was due, for an interval.
TEST(ForceLag, IsAFrameAndHalfAnApproachLive) {
  constexpr double kTick_s = 0.001;  // so much later than it is due a frame is noticed
  for (const int rate_Hz : {24, 30, 60}) {
    const double interval_s = 1.0 / rate_Hz;
    const double approach_s =
        1e-9 * static_cast<double>(WrenchTimeline::approach_after(std::llround(1e9 * interval_s)));
    EXPECT_NEAR(lag_s(rate_Hz, 0), interval_s + approach_s / 2, error_s(rate_Hz) + kTick_s)
        << rate_Hz;
  }
}

}  // namespace
}  // namespace spidar::test::force_lag_test
