// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames from which no motion can be determined: points and field report exactly none.
#include "core/motion/motion_estimator.h"
#include "core/points/tracker.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::hard_frames_test {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr int kFrames = 8;  // light steps and cuts come at the sixth
constexpr int64_t kFrame_ns = 40'000'000;

/// A film without a motion that may be felt, by the grey level at a position of frame n.
struct HardFilm {
  const char* name;
  double (*grey)(const Texture& texture, int n, double x, double y);
  double noise_grey = 0;
};

double still(const Texture& texture, int, double x, double y) {
  return texture.at(x, y);
}
double flat(const Texture&, int, double, double) {
  return 120;
}
/// Nobody can see how far a single slanted edge moves along itself. Without its soft 4 px it would
/// be a row of steps, which are corners.
double edge(const Texture&, int n, double x, double y) {
  const double side_px = (2 * (x - 245 - 2.25 * n) + (y - 138 + 0.75 * n)) / std::sqrt(5.0);
  return 128 + 60 * std::clamp(side_px / 2, -1.0, 1.0);
}
double light_step(const Texture& texture, int n, double x, double y) {
  return n < 6 ? texture.at(x, y) : 0.5 * texture.at(x, y) + 30;
}
double cut(const Texture& texture, int n, double x, double y) {
  return texture.at(n < 6 ? x : x + 10'000, y);
}

class HardFrames : public testing::TestWithParam<HardFilm> {};

TEST_P(HardFrames, ShowNoMotion) {
  for (const uint32_t seed : {1u, 2u}) {
    SCOPED_TRACE("picture " + std::to_string(seed));
    const Texture texture(seed, 8);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1);
    Picture picture(kWidth, kHeight);
    OpenCvTracker tracker;
    MotionEstimator estimator;
    ReducedFrame reduced;
    for (int n = 0; n < kFrames; ++n) {
      picture.fill([&](double x, double y) {
        const double grey = GetParam().grey(texture, n, x, y);
        return std::clamp(grey + GetParam().noise_grey * noise(random), 0.0, 255.0);
      });
      const ImageView frame = picture.view();
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
                         testing::Values(HardFilm{"Still", still}, HardFilm{"Flat", flat},
                                         HardFilm{"NoiseOnly", flat, 6},
                                         HardFilm{"SingleEdge", edge},
                                         HardFilm{"LightStep", light_step}, HardFilm{"Cut", cut}),
                         [](const auto& film) { return std::string(film.param.name); });

}  // namespace
}  // namespace spidar::test::hard_frames_test
