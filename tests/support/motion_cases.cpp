// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/motion_cases.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <tuple>

#include "tests/support/film_studio.h"
#include "tests/support/photo_sheet.h"

namespace spidar::test {
namespace {

using Eigen::Affine2d;
using Eigen::Rotation2Dd;
using Eigen::Vector2d;

/// σ of a good camera's noise, grey levels.
constexpr double kSensorNoise = 1.5;
constexpr double kDegree = M_PI / 180;

/// An object at a speed, px a frame at a width of 640.
Film object_at(FilmStudio& s, double speed) {
  const Vector2d step = speed * Vector2d(3, 1).normalized();
  return s.usual_object(step.x(), step.y());
}

Film rotating_object(FilmStudio& s) {
  Film film = s.still_film();
  const SheetPath path = s.crossing({7, -2});
  film.objects = {s.object(FilmStudio::kFraction, [path](double t) {
    return Affine2d(path(t) * Rotation2Dd(3 * kDegree * t));
  })};
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

struct Case {
  std::function<Film(FilmStudio&)> build;
  double least_noise = kSensorNoise;
};

const std::map<std::string, Case> kCases{
    // Speeds of the usual object, px a frame: mean 13.
    {"slow-object", {[](FilmStudio& s) { return object_at(s, 2); }}},
    {"object", {[](FilmStudio& s) { return object_at(s, 11); }}},
    {"fast-object", {[](FilmStudio& s) { return object_at(s, 26); }}},
    {"pan-object", {[](FilmStudio& s) { return s.pan_with_object(); }}},
    {"rotating-object", {rotating_object}},
    {"noise", {with_noise}},
    {"blur", {blurred}},
    {"motion-blur", {motion_blurred}},
    {"brightness", {brightness}},
    {"tiny-object", {tiny_object}},
    // Without a motion that may be felt.
    {"still", {[](FilmStudio& s) { return s.still_film(); }, 0}},
    {"flat", {[](FilmStudio& s) { return s.behind(s.plain(), still()); }, 0}},
    {"noise-only", {noise_only, 0}},
    {"single-edge", {single_edge, 0}},
    {"light-step", {light_step, 0}},
    {"cut", {cut, 0}},
};

}  // namespace

/// The sheets of the last requested size and seed are kept.
Film motion_case(const std::string& name, int width, int height, uint32_t seed) {
  static std::tuple<int, int, uint32_t> key;
  static std::unique_ptr<FilmStudio> studio;
  if (!studio || key != std::make_tuple(width, height, seed)) {
    studio = std::make_unique<FilmStudio>(width, height, seed);
    key = {width, height, seed};
  }
  const Case& found = kCases.at(name);
  Film film = found.build(*studio);
  film.noise = std::max(film.noise, found.least_noise);
  return film;
}

}  // namespace spidar::test
