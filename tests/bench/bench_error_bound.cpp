// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How often MovingObject::error_px_s holds, in random films of exactly known motion. Error
// and bound are in px a frame at a width of 640 px.
//   bench_error_bound [FIRST_SEED [SEEDS]]
// Seeds from 101 on were not used when the bound was chosen.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include <gst/gst.h>

#include "core/analysis/motion_analyzer.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/tracking/film_frames.h"
#include "tests/support/film_studio.h"

namespace {

using namespace spidar;
using Eigen::Affine2d;
using Eigen::Matrix2d;
using Eigen::Rotation2Dd;
using Eigen::Translation2d;
using Eigen::Vector2d;
using test::Film;
using test::FilmStudio;
using test::kFilmFrames;

constexpr int kFilmsOfSeed = 24;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;
constexpr double kReferenceWidth_px = 640;

/// What a film is like; lengths at a width of kReferenceWidth_px.
struct Kind {
  double share;  ///< of the frame that the object covers
  double speed_px;
  bool pans = false;
  bool turns = false;  ///< the camera zooms and rolls
  bool object_turns = false;
  bool speeds_up = false;
  bool noisy = false;
  bool blurred = false;  ///< out of focus, or by motion
  bool coded = false;
};

struct Measured {
  Kind kind;
  int width;
  double error_px;  ///< of the velocity, px a frame at kReferenceWidth_px
  double bound_px;
};

class Random {
 public:
  explicit Random(uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) {
    // <random>'s distributions differ between libraries.
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  double by_factors(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  bool chance(double p) { return uniform(0, 1) < p; }

 private:
  std::mt19937 random_;
};

struct RandomFilm {
  Kind kind;
  Film film;
};

RandomFilm random_film(FilmStudio& studio, Random& random) {
  Kind kind;
  kind.share = random.by_factors(0.01, 0.2);
  kind.speed_px = random.by_factors(1.5, 30);
  const double unit = studio.unit();
  const auto direction = [&](double length) -> Vector2d {
    return Rotation2Dd(random.uniform(-M_PI, M_PI)) * Vector2d(length, 0);
  };
  const double camera = random.uniform(0, 3);
  kind.pans = camera > 1;
  kind.turns = camera > 2;
  const Vector2d pan = kind.pans ? direction(random.uniform(0, 8)) : Vector2d(0, 0);
  const double grow = kind.turns ? random.uniform(-0.015, 0.015) : 0;
  const double roll = kind.turns ? random.uniform(-0.02, 0.02) : 0;
  Matrix2d generator;
  generator << grow, -roll, roll, grow;
  const test::SheetPath about = test::growing(generator);
  Film film =
      studio.camera([=](double t) { return Affine2d(Translation2d(t * unit * pan) * about(t)); });
  const test::SheetPath path = studio.crossing(direction(kind.speed_px), direction(40));
  kind.object_turns = random.chance(0.25);
  const double turn = kind.object_turns ? random.uniform(-0.05, 0.05) : 0;
  const double nearer = kind.object_turns ? random.uniform(-0.02, 0.02) : 0;
  kind.speeds_up = random.chance(0.25);
  const double swing = kind.speeds_up ? random.uniform(0.3, 1) : 0;
  const auto in_time = [swing](double t) { return t + swing * std::sin(t); };
  film.objects = {studio.object(kind.share, [=](double t) {
    return Affine2d(path(in_time(t)) * Rotation2Dd(turn * t) *
                    Eigen::Scaling(std::exp(nearer * (t - 6))));
  })};
  kind.noisy = random.chance(0.25);
  film.noise = kind.noisy ? random.uniform(3, 6) : 1.5;
  film.blur_px = random.chance(0.15) ? unit * random.uniform(0.7, 2) : 0;
  film.shutter = random.chance(0.25) ? random.uniform(0.25, 0.75) : 0;
  kind.blurred = film.blur_px > 0 || film.shutter > 0;
  kind.coded = random.chance(0.33);
  return {kind, std::move(film)};
}

/// The largest object whose middle is on the film's.
const MovingObject* found_object(const Frame& found, const Film& film, int n) {
  const MovingObject* largest = nullptr;
  const test::FilmObject& truth = film.objects[0];
  for (const MovingObject& object : found.objects) {
    const Vector2d on_object = truth.pose(n).inverse() * object.position_px;
    if (object.tracks == 0 || on_object.norm() > truth.radii_px.x()) continue;
    if (!largest || object.area_px2 > largest->area_px2) largest = &object;
  }
  return largest;
}

void measure(const RandomFilm& made, const std::vector<test::Picture>& frames,
             std::vector<Measured>& results) {
  const Film& film = made.film;
  MotionAnalyzer analyzer;
  const double to_reference = kReferenceWidth_px / film.width();
  for (int n = 0; n < kFilmFrames; ++n) {
    const Frame found = analyzer.analyze(frames[static_cast<size_t>(n)].view(), n * kFrame_ns);
    const MovingObject* object = found_object(found, film, n);
    if (!object || !film.is_in_view(n, film.objects[0])) continue;
    // Of an object that turns, the truth is that of the place that the velocity is said to be of.
    const test::SheetPath& pose = film.objects[0].pose;
    const Vector2d place_px =
        pose(n - 1) * (pose(n).inverse() * object->position_px) + film.middle_px();
    const Vector2d true_px = film.object_displacement_px(n, film.objects[0], place_px);
    const Vector2d found_px = object->relative_px_s * kFrame_s;
    results.push_back({made.kind, film.width(), to_reference * (found_px - true_px).norm(),
                       to_reference * object->error_px_s * kFrame_s});
  }
}

void measure(RandomFilm made, std::vector<Measured>& results) {
  std::vector<test::Picture> frames = bench::draw_all(made.film, kFilmFrames);
  if (made.kind.coded) frames = bench::coded(frames, bench::Coder::kOpenH264);
  measure(made, frames, results);
}

struct Group {
  const char* name;
  std::function<bool(const Measured&)> has;
};

void print(const Group& group, const std::vector<Measured>& all) {
  std::vector<double> errors, bounds;
  int covered = 0;
  for (const Measured& m : all) {
    if (!group.has(m)) continue;
    errors.push_back(m.error_px);
    bounds.push_back(m.bound_px);
    covered += m.error_px <= m.bound_px;
  }
  if (errors.empty()) return;
  std::printf("| %s | %zu | %.1f | %.3f | %.3f | %.3f | %.3f |\n", group.name, errors.size(),
              100.0 * covered / static_cast<double>(errors.size()), bench::quantile(errors, 0.5),
              bench::quantile(errors, 0.95), bench::quantile(bounds, 0.5),
              bench::quantile(bounds, 0.95));
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  const int first = argc > 1 ? std::atoi(argv[1]) : 101;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 12;
  std::vector<Measured> all;
  for (int seed = first; seed < first + seeds; ++seed) {
    const int width = seed % 4 == 0 ? 1280 : 640;
    FilmStudio studio(width, width * 9 / 16, static_cast<uint32_t>(seed));
    Random random(static_cast<uint32_t>(seed));
    for (int k = 0; k < kFilmsOfSeed; ++k) measure(random_film(studio, random), all);
  }
  const std::vector<Group> groups = {
      {"all", [](const Measured&) { return true; }},
      {"camera at rest", [](const Measured& m) { return !m.kind.pans; }},
      {"camera pans", [](const Measured& m) { return m.kind.pans && !m.kind.turns; }},
      {"camera pans, zooms and rolls", [](const Measured& m) { return m.kind.turns; }},
      {"small: below 3 % of the frame", [](const Measured& m) { return m.kind.share < 0.03; }},
      {"large: above 8 %", [](const Measured& m) { return m.kind.share > 0.08; }},
      {"slow: below 4 px a frame", [](const Measured& m) { return m.kind.speed_px < 4; }},
      {"fast: above 12 px", [](const Measured& m) { return m.kind.speed_px > 12; }},
      {"object turns and grows", [](const Measured& m) { return m.kind.object_turns; }},
      {"object speeds up and slows down", [](const Measured& m) { return m.kind.speeds_up; }},
      {"noise of 3 to 6 grey levels", [](const Measured& m) { return m.kind.noisy; }},
      {"out of focus or blurred by motion", [](const Measured& m) { return m.kind.blurred; }},
      {"through H.264", [](const Measured& m) { return m.kind.coded; }},
      {"1280×720", [](const Measured& m) { return m.width > 1000; }},
  };
  std::printf("| films | frames | covered %% | error median | 95 %% | bound median | 95 %% |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Group& group : groups) print(group, all);
  return 0;
}
