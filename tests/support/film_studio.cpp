// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/film_studio.h"

#include <cmath>
#include <utility>

#include "tests/support/photo_sheet.h"

namespace spidar::test {

using Eigen::Affine2d;
using Eigen::Translation2d;
using Eigen::Vector2d;

SheetPath still() {
  return [](double) { return Affine2d::Identity(); };
}

SheetPath straight(const Vector2d& start_px, const Vector2d& step_px) {
  return [=](double t) { return Affine2d(Translation2d(start_px + t * step_px)); };
}

Film FilmStudio::still_film() {
  return behind(background(), still());
}

Film FilmStudio::behind(std::shared_ptr<const SplineSheet> sheet, SheetPath pose) const {
  Film film(width_, height_);
  film.background = {std::move(sheet), std::move(pose)};
  film.noise_seed = seed_ * 1000;
  return film;
}

Film FilmStudio::pan(double x, double y) {
  return behind(background(), straight({0, 0}, unit_ * Vector2d(x, y)));
}

Film FilmStudio::usual_object(double x, double y) {
  Film film = still_film();
  film.objects = {object(kFraction, crossing({x, y}))};
  return film;
}

Film FilmStudio::pan_with_object() {
  Film film = pan(-4, 1.5);
  film.objects = {object(kFraction, crossing({9, 2.5}))};
  return film;
}

FilmObject FilmStudio::object(double fraction, SheetPath pose, const std::string& name) {
  const double radius_px = std::sqrt(fraction * width_ * height_ / M_PI);
  return {sheet(name, 0.6), {radius_px, radius_px}, std::move(pose)};
}

SheetPath FilmStudio::crossing(const Vector2d& step, const Vector2d& middle) const {
  return straight(unit_ * (middle - (kFilmFrames - 1) / 2.0 * step), unit_ * step);
}

std::shared_ptr<const SplineSheet> FilmStudio::background(const std::string& name) {
  return sheet(name, 1.5);
}

std::shared_ptr<const SplineSheet> FilmStudio::plain() const {
  return std::make_shared<SplineSheet>(plain_sheet(120));
}

std::shared_ptr<const SplineSheet> FilmStudio::sheet(const std::string& name, double frames_wide) {
  std::shared_ptr<const SplineSheet>& found = sheets_[name];
  if (!found) {
    // The seed depends on the name, so that a film is the same whichever others are made.
    uint32_t seed = seed_;
    for (const char c : name) seed = 31 * seed + static_cast<uint32_t>(c);
    found = std::make_shared<SplineSheet>(
        photo_sheet(100 * seed, frames_wide * width_, frames_wide * height_));
  }
  return found;
}

}  // namespace spidar::test
