// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/motion_cases.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "tests/support/film_studio.h"
#include "tests/support/photo_sheet.h"

namespace spidar::test {
namespace {

using Eigen::Affine2d;
using Eigen::Matrix2d;
using Eigen::Rotation2Dd;
using Eigen::Translation2d;
using Eigen::Vector2d;

/// σ of a good camera's noise, grey levels.
constexpr double kSensorNoise = 1.5;
constexpr double kDegree = M_PI / 180;

/// An object at a speed, px a frame at a width of 640.
Film object_at(FilmStudio& s, double speed) {
  const Vector2d step = speed * Vector2d(3, 1).normalized();
  return s.usual_object(step.x(), step.y());
}

Matrix2d matrix(double xx, double xy, double yx, double yy) {
  Matrix2d m;
  m << xx, xy, yx, yy;
  return m;
}

Film rotating_object(FilmStudio& s) {
  Film film = s.still_film();
  const SheetPath path = s.crossing({7, -2});
  film.objects = {s.object(FilmStudio::kFraction, [path](double t) {
    return Affine2d(path(t) * Rotation2Dd(3 * kDegree * t));
  })};
  return film;
}

Film several_objects(FilmStudio& s) {
  Film film = s.still_film();
  film.objects = {s.object(0.06, s.crossing({8, 0}, {-150, -80}), "object"),
                  s.object(0.05, s.crossing({-6, 4}, {160, -30}), "second"),
                  s.object(0.04, s.crossing({-2, -9}, {0, 90}), "third")};
  return film;
}

Film entering(FilmStudio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.objects = {
      s.object(FilmStudio::kFraction, straight(u * Vector2d(-400, 20), u * Vector2d(24, -2)))};
  return film;
}

Film with_noise(FilmStudio& s) {
  Film film = s.pan_with_object();
  film.noise = 6;
  return film;
}

Film blurred(FilmStudio& s) {
  Film film = s.pan_with_object();
  film.blur_px = 2 * s.unit();
  return film;
}

/// A 180° shutter.
Film motion_blurred(FilmStudio& s) {
  Film film = object_at(s, 16);
  film.shutter = 0.5;
  return film;
}

Film brightness(FilmStudio& s) {
  Film film = s.pan_with_object();
  film.light = [](int n) { return Light{1 - 0.03 * n, 2.0 * n}; };
  return film;
}

Film tiny_object(FilmStudio& s) {
  Film film = s.still_film();
  film.objects = {s.object(0.01, s.crossing({10, 3}), "tiny")};
  return film;
}

Film noise_only(FilmStudio& s) {
  Film film = s.behind(s.plain(), still());
  film.noise = 6;
  return film;
}

/// A single slanted edge that moves: nobody can see how far along itself.
Film single_edge(FilmStudio& s) {
  Film film = s.still_film();
  const double u = s.unit();
  film.background = {
      std::make_shared<SplineSheet>(edge_sheet(1000 * u, 600 * u, {10 * u, 5 * u}, {2, 1})),
      straight({0, 0}, u * Vector2d(3, -1))};
  return film;
}

Film light_step(FilmStudio& s) {
  Film film = s.still_film();
  film.light = [](int n) { return n < 6 ? Light() : Light{0.5, 30}; };
  return film;
}

Film cut(FilmStudio& s) {
  Film film = s.still_film();
  film.cut_at = 6;
  film.after_cut = {s.background("other"), still()};
  return film;
}

using Build = std::function<Film(FilmStudio&)>;

/// The sheets of the last requested size and seed are kept.
MotionCase make(std::string name, CaseGroup group, Build build, bool coded = false) {
  return {std::move(name), group, coded, [group, build](int width, int height, uint32_t seed) {
            static std::tuple<int, int, uint32_t> key;
            static std::unique_ptr<FilmStudio> studio;
            if (!studio || key != std::make_tuple(width, height, seed)) {
              studio.reset();
              studio = std::make_unique<FilmStudio>(width, height, seed);
              key = {width, height, seed};
            }
            Film film = build(*studio);
            if (group != CaseGroup::kSilent) film.noise = std::max(film.noise, kSensorNoise);
            return film;
          }};
}

std::vector<MotionCase> all_cases() {
  const CaseGroup usual = CaseGroup::kUsual;
  const CaseGroup hard = CaseGroup::kHard;
  const CaseGroup silent = CaseGroup::kSilent;
  const double roll = 1.2 * kDegree;
  return {
      make("translation", usual, [](FilmStudio& s) { return s.pan(5.3, 2.1); }),
      make("rotation", usual,
           [=](FilmStudio& s) { return s.camera(growing(matrix(0, -roll, roll, 0))); }),
      make("zoom", usual,
           [](FilmStudio& s) { return s.camera(growing(matrix(0.012, 0, 0, 0.012))); }),
      make("affine", usual,
           [](FilmStudio& s) { return s.camera(growing(matrix(0.008, 0.012, -0.004, -0.003))); }),
      make("slow-object", usual, [](FilmStudio& s) { return object_at(s, kSlow_px); }),
      make("object", usual, [](FilmStudio& s) { return object_at(s, kNormal_px); }),
      make("fast-object", usual, [](FilmStudio& s) { return object_at(s, kFast_px); }),
      make("pan-object", usual, [](FilmStudio& s) { return s.pan_with_object(); }),
      make("rotating-object", usual, rotating_object),
      make("several-objects", usual, several_objects),
      make("noise", usual, with_noise),
      make("blur", usual, blurred),
      make("motion-blur", usual, motion_blurred),
      make("brightness", usual, brightness),
      make("entering-object", usual, entering),
      make(
          "x264-object", usual, [](FilmStudio& s) { return object_at(s, kNormal_px); }, true),
      make(
          "x264-pan-object", usual, [](FilmStudio& s) { return s.pan_with_object(); }, true),
      make("tiny-object", hard, tiny_object),
      make("still", silent, [](FilmStudio& s) { return s.still_film(); }),
      make("flat", silent, [](FilmStudio& s) { return s.behind(s.plain(), still()); }),
      make("noise-only", silent, noise_only),
      make("single-edge", silent, single_edge),
      make("light-step", silent, light_step),
      make("cut", silent, cut),
  };
}

}  // namespace

const std::vector<MotionCase>& motion_cases() {
  static const std::vector<MotionCase> cases = all_cases();
  return cases;
}

const MotionCase& motion_case(const std::string& name) {
  std::string names;
  for (const MotionCase& known : motion_cases()) {
    if (known.name == name) return known;
    names += (names.empty() ? "" : ", ") + known.name;
  }
  throw std::invalid_argument("no case '" + name + "'; there are " + names);
}

}  // namespace spidar::test
