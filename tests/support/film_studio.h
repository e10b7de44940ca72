// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "tests/support/known_motion.h"

namespace spidar::test {

SheetPath still();
/// From `start_px` by `step_px` a frame.
SheetPath straight(const Eigen::Vector2d& start_px, const Eigen::Vector2d& step_px);

/// Renders films of one size from the same sheets. Lengths are at a width of 640 px: a wider film
/// shows the same with more detail. Sheets are drawn when a film first needs them and stored for
/// the next ones, because they take longer than a film.
class FilmStudio {
 public:
  FilmStudio(int width, int height, uint32_t seed)
      : width_(width), height_(height), seed_(seed), unit_(width / 640.0) {}

  /// Pixels of the frame per pixel at a width of 640.
  double unit() const { return unit_; }

  Film still_film();
  Film behind(std::shared_ptr<const SplineSheet> sheet, SheetPath pose) const;
  Film pan(double x, double y);
  /// A disc of kFraction of the frame.
  Film usual_object(double x, double y);
  Film pan_with_object();

  /// A disc that covers `fraction` of the frame. A different name gives a different picture.
  FilmObject object(double fraction, SheetPath pose, const std::string& name = "object");
  static constexpr double kFraction = 0.08;
  /// A motion by `step` a frame that passes `middle` when half of the frames have passed.
  SheetPath crossing(const Eigen::Vector2d& step, const Eigen::Vector2d& middle = {0, 0}) const;

  std::shared_ptr<const SplineSheet> background(const std::string& name = "background");
  std::shared_ptr<const SplineSheet> plain() const;

 private:
  std::shared_ptr<const SplineSheet> sheet(const std::string& name, double frames_wide);

  int width_;
  int height_;
  uint32_t seed_;
  double unit_;
  std::map<std::string, std::shared_ptr<const SplineSheet>> sheets_;
};

/// The frames of a film, in which nothing leaves its sheet or the view at the speeds in use.
constexpr int kFilmFrames = 12;

}  // namespace spidar::test
