// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Renders films of one size from the same sheets.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "tests/support/known_motion.h"

namespace spidar::test {

/// Stays in place.
SheetPath still();
/// From `start_px` by `step_px` a frame.
SheetPath straight(const Eigen::Vector2d& start_px, const Eigen::Vector2d& step_px);
/// About the middle by exp(t · generator), |t · generator| < 1.
SheetPath growing(const Eigen::Matrix2d& generator);

/// Lengths given to its functions are at a width of 640 px: a wider film shows the same with more
/// detail. Sheets are drawn when a film first needs them and kept for the next ones: they take
/// longer than a film does.
class FilmStudio {
 public:
  FilmStudio(int width, int height, uint32_t seed)
      : width_(width), height_(height), seed_(seed), unit_(width / 640.0) {}

  /// Pixels of the frame to one at a width of 640.
  double unit() const { return unit_; }

  /// A still film.
  Film still_film();
  Film behind(std::shared_ptr<const SplineSheet> sheet, SheetPath pose) const;
  Film camera(SheetPath pose);
  Film pan(double x, double y);
  /// A disc of kFraction of the frame.
  Film usual_object(double x, double y);
  /// The same in front of a pan.
  Film pan_with_object();

  /// A disc that covers `fraction` of the frame. A different name gives a different picture.
  FilmObject object(double fraction, SheetPath pose, const std::string& name = "object");
  static constexpr double kFraction = 0.08;
  /// Moves by `step` a frame, and passes through `middle` when half of the frames have passed.
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

/// Frames of a film; with the speeds in use nothing leaves its sheet or runs out of view before.
constexpr int kFilmFrames = 12;

}  // namespace spidar::test
