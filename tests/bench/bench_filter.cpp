// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the 1 € filter takes from the error of a measured motion, and by how much it makes the
// motion late: a disc of known motion in front of a texture, with noise, 30 frames/s, 640 × 480.
//   error   rms of the velocity of a steady motion, on one axis, px/s
//   late    ms by which the velocity is behind, as fits all frames best: error = -late ·
//   acceleration max     largest error of the filter, that is of its result against its input, px/s
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "core/analysis/motion_analyzer.h"
#include "core/force/motion_filter.h"
#include "tests/bench/benchmarks.h"
#include "tests/support/moving_scene.h"

namespace {

using namespace spidar;
using Eigen::Vector2d;

constexpr int64_t kFrame_ns = 33'333'333;
constexpr double kFrame_s = 1e-9 * static_cast<double>(kFrame_ns);
constexpr int kFrames = 240, kWidth = 640, kHeight = 480;
/// Frames before the rate of change is known: three time constants of its low-pass are 0.5 s.
constexpr int kBegin = 30;
constexpr double kNoise_grey = 2, kRadius_px = 50;

struct Motion {
  const char* name;
  std::function<Vector2d(double)> centre_px;
};

struct Film {
  std::vector<ImageMotion> measured;
  std::vector<Vector2d> true_px_s;
};

Film film_of(const Motion& motion) {
  test::MovingScene scene(kWidth, kHeight);
  scene.add_disc(kRadius_px);
  test::Picture noisy(kWidth, kHeight);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, kNoise_grey);
  AnalyzerSettings settings;
  settings.filter.min_cutoff_Hz = 0;
  MotionAnalyzer analyzer(settings);
  Film film;
  for (int n = 0; n < kFrames; ++n) {
    const Vector2d now_px = motion.centre_px(n * kFrame_s);
    const ImageView drawn = scene.draw({}, {{now_px}});
    noisy.fill([&](double x, double y) {
      const uint8_t grey = *drawn.at(static_cast<int>(x), static_cast<int>(y));
      return std::clamp(grey + noise(random), 0.0, 255.0);
    });
    const Frame& frame = analyzer.analyze(noisy.view(), n * kFrame_ns);
    film.measured.push_back(frame.motion);
    film.true_px_s.push_back((now_px - motion.centre_px((n - 1) * kFrame_s)) / kFrame_s);
  }
  return film;
}

std::vector<Vector2d> filtered(const Film& film, const FilterSettings& settings) {
  MotionFilter filter;
  std::vector<Vector2d> result;
  for (const ImageMotion& motion : film.measured)
    result.push_back(filter.filter(motion, kHeight, kFrame_s, settings).velocity_px_s);
  return result;
}

double error_px_s(const Film& film, const FilterSettings& settings) {
  const std::vector<Vector2d> found = filtered(film, settings);
  double sum = 0;
  for (size_t n = kBegin; n < found.size(); ++n)
    sum += (found[n] - film.true_px_s[n]).squaredNorm() / 2;  // of one axis
  return std::sqrt(sum / static_cast<double>(found.size() - kBegin));
}

double late_ms(const Film& film, const FilterSettings& settings) {
  const std::vector<Vector2d> found = filtered(film, settings);
  double product = 0, square = 0;
  for (size_t n = kBegin; n + 1 < found.size(); ++n) {
    const Vector2d rate = (film.true_px_s[n + 1] - film.true_px_s[n - 1]) / (2 * kFrame_s);
    product -= rate.dot(found[n] - film.true_px_s[n]);
    square += rate.squaredNorm();
  }
  return 1e3 * product / square;
}

double largest_px_s(const Film& film, const FilterSettings& settings) {
  const std::vector<Vector2d> found = filtered(film, settings);
  double largest = 0;
  for (size_t n = kBegin; n < found.size(); ++n)
    largest = std::max(largest, (found[n] - film.measured[n].velocity_px_s).norm());
  return largest;
}

Vector2d sway_px(double size_px, double rate_Hz, double time_s) {
  return {size_px * std::sin(2 * M_PI * rate_Hz * time_s), 0};
}

}  // namespace

int spidar::bench::filter(int, char**) {
  const Film steady = film_of({"steady", [](double t_s) { return Vector2d(60 * t_s - 240, 0); }});
  std::vector<Film> sways;
  std::printf("| filter-beta | steady: error |");
  for (const Motion& motion : {
           Motion{"sway of 157 px/s, 1/4 Hz", [](double t_s) { return sway_px(100, 0.25, t_s); }},
           Motion{"of 377 px/s, 1 Hz", [](double t_s) { return sway_px(60, 1, t_s); }},
           Motion{"of 201 px/s, 2 Hz", [](double t_s) { return sway_px(16, 2, t_s); }},
       }) {
    sways.push_back(film_of(motion));
    std::printf(" %s: late, max |", motion.name);
  }
  std::printf("\n|---|---|---|---|---|\n");
  for (const FilterSettings& settings :
       {FilterSettings{0, 0}, {1, 0}, {1, 0.03}, {1, 0.08}, {1, 0.2}}) {
    settings.min_cutoff_Hz == 0 ? std::printf("| no filter |")
                                : std::printf("| %.2f |", settings.beta_s_px);
    std::printf(" %.2f |", error_px_s(steady, settings));
    for (const Film& film : sways)
      std::printf(" %.0f, %.1f |", late_ms(film, settings), largest_px_s(film, settings));
    std::printf("\n");
  }
  return 0;
}
