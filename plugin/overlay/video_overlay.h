// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>
#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"
#include "plugin/overlay/plot_axis.h"

namespace spidar {

/// The force of the last seconds as a curve.
class ForceCurve {
 public:
  static constexpr int64_t kLength_ns = 5'000'000'000;  ///< as in the plots of the debug window
  /// The end of the axis of a stream in which hardly anything is felt.
  static constexpr double kMinTop_N = 0.5;

  /// Adds the force of a frame. A time before that of the previous frame begins another stream.
  void add(int64_t time_ns, double force_N) {
    if (!points_.empty() && time_ns < points_.back().time_ns) *this = {};
    points_.push_back({time_ns, force_N});
    largest_N_ = std::max(largest_N_, force_N);
    while (points_.front().time_ns < time_ns - kLength_ns) points_.pop_front();
  }

  /// The axis from 0 to a round number that no force of the stream has exceeded, for comparable
  /// heights.
  PlotAxis axis() const { return make_axis(0, round_top(std::max(largest_N_, kMinTop_N)), 1); }

  /// Returns the curve, oldest first, as fractions: x from 0, kLength_ns ago, to 1, the newest
  /// frame; y from 0 N to 1, the end of axis().
  std::vector<Eigen::Vector2d> positions() const {
    std::vector<Eigen::Vector2d> positions;
    positions.reserve(points_.size());
    const PlotAxis y = axis();
    for (const Point& point : points_) {
      const auto ago_ns = static_cast<double>(points_.back().time_ns - point.time_ns);
      positions.emplace_back(1 - ago_ns / static_cast<double>(kLength_ns),
                             y.fraction(point.force_N));
    }
    return positions;
  }

 private:
  struct Point {
    int64_t time_ns;
    double force_N;
  };
  std::deque<Point> points_;
  double largest_N_ = 0;
};

/// Draws the box of each object, thick if it is felt, and the wanted force in newtons as a white
/// arrow with a black border, which begins on the object (see force_origin_px()). While the picture
/// is touched, also draws the finger as a ring, the touched point as a disc that grows with the
/// force, and the contact force from that point. With `has_points`, also draws one arrow per point
/// and a cross at each lost point. Draws a `curve` along the lower edge, or the upper one where the
/// report has subtitles. `frame` must be mapped for writing.
void draw_overlay(const DrawnFrame& report, bool has_points, double scale, GstVideoFrame& frame,
                  const ForceCurve* curve = nullptr);

}  // namespace spidar
