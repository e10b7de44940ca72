// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The tracker on frames with a known motion.
#include "tests/core/moving_texture.h"
#include "tests/support/ball_scene.h"
#include "tests/support/test.h"

namespace spidar::test::tracker_test {
namespace {

struct Translation {
  int width, height;
  double dx_px, dy_px;
};

const Translation kTranslations[] = {
    {640, 360, 0, 0},       {640, 360, 0.25, -0.4}, {640, 360, 3.3, 1.7},
    {640, 360, -17.6, 9.2}, {641, 359, 2.5, -2.5},  {322, 241, -1.3, 0.6},
    {1280, 720, 5.7, -3.1}, {1920, 1080, 0.9, 0.7}, {1080, 1920, -8.2, 6.6}};

TEST(OpenCvTracker, FindsAKnownTranslationToAPartOfAPixel) {
  for (const Translation& p : kTranslations) {
    SCOPED_TRACE(testing::Message()
                 << p.width << "x" << p.height << " moves " << p.dx_px << ", " << p.dy_px);
    const double unit = reduction(p.width, p.height);
    MovingTexture scene(p.width, p.height, p.dx_px, p.dy_px);
    OpenCvTracker tracker;
    int looked_for = tracker.track(scene.frame(0)).features;
    ASSERT_GE(looked_for, 50);
    for (int n = 1; n <= 3; ++n) {
      const OpenCvTracker::Result& frame = tracker.track(scene.frame(n));
      ASSERT_NE(frame.picture, FrameComparison::kFirst);
      // All but those that leave: the fraction that leaves a frame is at most the displaced margin.
      const double margin = std::abs(p.dx_px) / p.width + std::abs(p.dy_px) / p.height;
      EXPECT_GE(static_cast<double>(frame.points.size()), looked_for * (0.9 - 2 * margin)) << n;
      double sum_x = 0;
      double sum_y = 0;
      for (const FollowedPoint& point : frame.points) {
        EXPECT_NEAR(dx(point), p.dx_px, kPointTolerance_px * unit) << point.from.x_px;
        EXPECT_NEAR(dy(point), p.dy_px, kPointTolerance_px * unit) << point.from.y_px;
        sum_x += dx(point);
        sum_y += dy(point);
      }
      const auto count = static_cast<double>(frame.points.size());
      EXPECT_NEAR(sum_x / count, p.dx_px, kMeanTolerance_px * unit);
      EXPECT_NEAR(sum_y / count, p.dy_px, kMeanTolerance_px * unit);
      looked_for = frame.features;
    }
  }
}

TEST(OpenCvTracker, APeriodicTextureDoesNotJumpAPeriod) {
  // Every 12 px the picture is the same: of all displacements that explain it the smallest is
  // meant.
  constexpr double kWave_px = 2 * M_PI / 12;
  Picture picture(640, 360);
  OpenCvTracker tracker;
  for (int n = 0; n < 4; ++n) {
    picture.fill([n](double x, double y) {
      return 128 + 50 * std::sin(kWave_px * (x - 2 * n)) + 50 * std::sin(kWave_px * (y + n));
    });
    const OpenCvTracker::Result& frame = tracker.track(picture.view());
    if (n == 0) continue;
    ASSERT_GE(frame.points.size(), 50u);
    for (const FollowedPoint& point : frame.points) {
      EXPECT_NEAR(dx(point), 2, kPointTolerance_px) << n;
      EXPECT_NEAR(dy(point), -1, kPointTolerance_px) << n;
    }
  }
}

TEST(OpenCvTracker, APointKeepsItsIdAndStartsWhereItEnded) {
  MovingTexture scene(640, 360, 1.5, 0.5);
  OpenCvTracker tracker;
  tracker.track(scene.frame(0));
  std::map<uint32_t, ImagePoint> last;
  for (int n = 1; n <= 12; ++n) {
    const OpenCvTracker::Result& frame = tracker.track(scene.frame(n));
    std::map<uint32_t, ImagePoint> now;
    size_t known = 0;
    for (const FollowedPoint& point : frame.points) {
      EXPECT_TRUE(now.insert({point.id, point.to}).second) << "id twice: " << point.id;
      const auto before = last.find(point.id);
      if (before == last.end()) continue;
      ++known;
      EXPECT_EQ(before->second.x_px, point.from.x_px);
      EXPECT_EQ(before->second.y_px, point.from.y_px);
    }
    if (n > 1) {
      EXPECT_GE(known * 2, frame.points.size()) << n;
    }
    last = now;
  }
}

TEST(OpenCvTracker, APointStartsWhereItEndedAlsoAfterARepeatedFrame) {
  // New points on a rim may be taken for others beside them, but not once they have been reported.
  const Texture behind(3, 6);
  const Texture disc(4, 6);
  Picture picture(480, 360);
  const auto frame = [&](double moved_px) {
    picture.fill([&](double x, double y) {
      const bool is_disc = std::hypot(x - moved_px - 240, y - 180) < 90;
      return is_disc ? disc.at(x - moved_px, y) : behind.at(x, y);
    });
    return picture.view();
  };
  OpenCvTracker tracker;
  tracker.track(frame(0));
  std::map<uint32_t, ImagePoint> ended;
  for (const FollowedPoint& point : tracker.track(frame(0)).points) ended[point.id] = point.to;
  ASSERT_GE(ended.size(), 50u);
  for (const FollowedPoint& point : tracker.track(frame(4)).points) {
    ASSERT_EQ(ended.count(point.id), 1u);
    EXPECT_EQ(point.from.x_px, ended[point.id].x_px);
    EXPECT_EQ(point.from.y_px, ended[point.id].y_px);
  }
}

TEST(OpenCvTracker, PointsThatLeaveTheFrameAreDroppedNotStill) {
  constexpr double kSpeed_px = 25;
  MovingTexture scene(640, 360, kSpeed_px, 0);
  OpenCvTracker tracker;
  int looked_for = tracker.track(scene.frame(0)).features;
  int dropped = 0;
  for (int n = 1; n <= 8; ++n) {
    const OpenCvTracker::Result& frame = tracker.track(scene.frame(n));
    dropped += looked_for - static_cast<int>(frame.points.size());
    for (const FollowedPoint& point : frame.points) {
      EXPECT_NEAR(dx(point), kSpeed_px, kPointTolerance_px) << n << " from " << point.from.x_px;
      EXPECT_LE(point.to.x_px, 639);
    }
    looked_for = frame.features;
  }
  // A strip of 25 of 640 px leaves with each frame.
  EXPECT_GE(dropped, 8);
}

TEST(OpenCvTracker, SettingsTakeEffectWithTheNextFrame) {
  MovingTexture scene(640, 360, 1, 0);
  TrackerSettings settings;
  OpenCvTracker tracker(settings);
  EXPECT_GT(tracker.track(scene.frame(0)).features, 100);
  settings.min_distance_px = 1e3;  // further than any two points of the picture are apart
  tracker.configure(settings);
  EXPECT_EQ(tracker.track(scene.frame(1)).features, 1);
  settings.min_distance_px = 10;
  tracker.configure(settings);
  const OpenCvTracker::Result& more = tracker.track(scene.frame(2));
  EXPECT_GT(more.features, 100);
  EXPECT_LE(more.points.size(), 1u);
}

TEST(OpenCvTracker, WorksFromTheSmallestFrameToTheLargest) {
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{16, 16}, Size{17, 31}, Size{8192, 16}, Size{16, 8192}, Size{481, 17},
                          Size{8192, 8192}}) {
    Picture picture(size.width, size.height);
    // Cells of 3 px of the reduced picture; drawn once, since the largest has 67 million pixels.
    const double cell_px = 3 * std::max(1.0, std::min(size.width, size.height) / 480.0);
    const Texture texture(4, cell_px);
    if (size.width * size.height < 1'000'000) {
      picture.fill([&](double x, double y) { return texture.at(x, y); });
    } else {
      picture.fill([](double x, double y) { return std::fmod(x * y / 4096, 200); });
    }
    OpenCvTracker tracker;
    EXPECT_EQ(tracker.track(picture.view()).picture, FrameComparison::kFirst);
    const OpenCvTracker::Result& frame = tracker.track(picture.view());
    EXPECT_NE(frame.picture, FrameComparison::kFirst) << size.width << "x" << size.height;
    EXPECT_GE(frame.points.size(), 1u) << size.width << "x" << size.height;
    for (const FollowedPoint& point : frame.points) {
      EXPECT_NEAR(dx(point), 0, 1e-3);
      EXPECT_NEAR(dy(point), 0, 1e-3);
    }
  }
}

/// Points that begin on the ball and follow it.
int on_ball(const OpenCvTracker::Result& frame, const BallScene& scene, double t0_s, double t1_s) {
  const Eigen::Vector2d centre = scene.position_px(t0_s);
  const Eigen::Vector2d moved = scene.position_px(t1_s) - centre;
  return static_cast<int>(
      std::count_if(frame.points.begin(), frame.points.end(), [&](const FollowedPoint& t) {
        const Eigen::Vector2d from(static_cast<double>(t.from.x_px),
                                   static_cast<double>(t.from.y_px));
        return (from - centre).norm() < scene.settings().radius_px &&
               (Eigen::Vector2d(dx(t), dy(t)) - moved).norm() < 2 * kPointTolerance_px;
      }));
}

/// The most points on a ball that has just come in from the left.
int found_on_entering_ball(uint32_t seed) {
  BallSettings settings;
  settings.seed = seed;
  settings.textured_background = true;
  settings.radius_px = 70;
  settings.start_px = {-160, 180};
  settings.horizontal_px_s = 240;
  settings.floor_px = 251;
  BallScene scene(settings);
  OpenCvTracker tracker;
  constexpr double kFrame_s = 1.0 / 30;
  int most = 0;
  // The ball is wholly inside after 230 px, 29 frames. Points are selected every 5 frames at the
  // latest, and followed from the next on.
  for (int n = 0; n <= 29 + 6; ++n) {
    const OpenCvTracker::Result& frame = tracker.track(scene.draw(n * kFrame_s));
    if (n > 0) most = std::max(most, on_ball(frame, scene, (n - 1) * kFrame_s, n * kFrame_s));
  }
  return most;
}

TEST(OpenCvTracker, AnObjectThatEntersAFullPictureGetsItsFractionOfThePoints) {
  // All 200 points are taken when it comes. Away from its edge it covers 60² π of 626 × 346 px, 5.2
  // % or 10 points if all textures were equally strong: half of that on average over six textures,
  // and at least one on the weakest.
  int sum = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const int found = found_on_entering_ball(seed);
    EXPECT_GE(found, 1) << "seed " << seed;
    sum += found;
  }
  EXPECT_GE(sum, 6 * 5);
}

}  // namespace
}  // namespace spidar::test::tracker_test
