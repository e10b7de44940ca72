// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/overlay/plot_axis.h"
#include "plugin/window/program/style.h"

namespace spidar::window {

/// The range of values in one of several equal parts of the x axis.
struct PlotSpan {
  bool is_empty = true;
  double low = 0, high = 0;
};

class Plot {
 public:
  /// Draws axes with labels along the left and lower edge of `panel`, and units at their ends.
  Plot(const Brush& brush, const Rect& panel, const PlotAxis& x, const PlotAxis& y,
       const std::string& x_unit, const std::string& y_unit);

  /// Draws a line through points in order, cut off beyond the range; a small triangle at the edge
  /// shows where a value is above it.
  void line(const std::vector<Eigen::Vector2d>& points, ImU32 color, double width_px = 1.6) const;
  /// Draws a band from the lowest to the highest value in each part of the width, at least
  /// `width_px` thick.
  void band(const std::vector<PlotSpan>& spans, ImU32 color, double width_px = 1.6) const;
  void upright(double x, ImU32 color) const;
  void dot(double x, double y, ImU32 color) const;
  /// Draws names beside each other at the upper right, in their colours, as many as fit.
  void legend(const std::vector<std::pair<const char*, ImU32>>& keys) const;

  const Rect& area() const { return area_; }
  ImVec2 at(double x, double y) const;
  /// The mouse's position on the x axis, marked by a line; nothing while the mouse is elsewhere.
  std::optional<double> hovered_x() const;

  static int steps_across(const Brush& brush, double width_px);
  static int steps_up(const Brush& brush, double height_px);

 private:
  void draw_axes(const std::string& x_unit, const std::string& y_unit) const;

  const Brush& brush_;
  Rect area_;
  PlotAxis x_, y_;
  float unit_width_ = 0;  ///< of the y axis
};

}  // namespace spidar::window
