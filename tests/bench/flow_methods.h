// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Other ways to find what moves in a picture, to compare speed and error with: flows of OpenCV,
/// each with the same robust homography for the camera, and the largest region that deviates from
/// it as the object.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/motion/camera/motion_models.h"
#include "core/picture/image_view.h"

namespace spidar::bench {

/// What counts as an object: it moves by so many px of a frame 480 lines high and more, and fills
/// so many cells of a FlowGrid.
struct Threshold {
  double least_px;
  size_t least_cells;
};

/// Those that are tried for each method that has any.
const std::vector<Threshold>& thresholds();

/// Motion of the object in px since the frame before, against the background.
class Method {
 public:
  virtual ~Method() = default;
  /// By threshold, or one for all. `frame` need not outlive the call.
  virtual std::vector<Eigen::Vector2d> find(const ImageView& frame, int64_t time_ns) = 0;
};

/// By name:
///   object:SIZE, paper                 settings of MotionAnalyzer
///   dis:ultrafast|medium:SIZE          dense flow (DIS) at SIZE, a fraction of the picture's width
///   lk:POINTS                          pyramidal Lucas–Kanade of so many Shi–Tomasi points
///   phase:SIZE                         phase correlation of blocks of 32 px
/// Throws std::invalid_argument, which lists them.
std::unique_ptr<Method> make_method(const std::string& name);

/// Flow at each point of a grid, px; where it is not known, nothing.
struct FlowGrid {
  static constexpr int kStep_px = 16;

  FlowGrid(int width, int height)
      : columns(width / kStep_px),
        rows(height / kStep_px),
        moved_px(static_cast<size_t>(columns * rows), Eigen::Vector2d::Zero()),
        known(moved_px.size(), 0) {}
  /// From the middle of the picture.
  Eigen::Vector2d at_px(size_t i) const;

  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector2d> moved_px;
  std::vector<uint8_t> known;
};

/// Median motion of the largest region that differs from a homography, against it.
class LargestRegion {
 public:
  /// By threshold.
  std::vector<Eigen::Vector2d> find(const FlowGrid& flow, double px_of_480_lines);

 private:
  std::vector<size_t> largest(const FlowGrid& flow, double least_px);
  std::vector<size_t> fill(const FlowGrid& flow, size_t seed);
  double median(const std::vector<size_t>& region, Eigen::Index coordinate) const;

  MotionModel last_;
  std::vector<Eigen::Vector2d> rest_px_;
  std::vector<uint8_t> moves_;
};

}  // namespace spidar::bench
