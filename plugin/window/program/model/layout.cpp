// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/layout.h"

#include <algorithm>
#include <cmath>

namespace spidar::window {
namespace {

// Fractions of the window.
constexpr double kLeft = 0.66, kGrip = 0.3, kTensions = 0.2;
constexpr double kTimeline = 0.13, kPlots = 0.23;
/// The height of the text, in pixels at a scale of 1; at most a fraction of the window.
constexpr double kStatus_px = 34, kStatusMost = 0.1;
/// The title, the button, a line and the film below each other; at most a fraction of the window.
constexpr double kTimeline_px = 96, kTimelineMost = 0.2, kTimelineAlone = 0.3;
constexpr double kGap_px = 8;
// Smaller panels cut a title, a row of buttons, a value with its unit, or the labels of an axis; in
// pixels at a scale of 1.
constexpr double kPlotWidth_px = 140, kPlotHeight_px = 104, kControls_px = 236;
constexpr double kGripHeight_px = 104, kTensionsHeight_px = 92;

constexpr double kTurn = 0.4, kTilt = 0.3;  // the view is turned about y, then tilted, radians
/// The part of the panel for the exits of the strings; the rest is for their numbers.
constexpr double kFilled = 0.8;

}  // namespace

Rect fit(const Rect& outer, double aspect) {
  const double width = std::min(outer.width, outer.height * aspect);
  const double height = width / aspect;
  return {outer.x + (outer.width - width) / 2, outer.y + (outer.height - height) / 2, width,
          height};
}

double text_scale(double screen_scale, int width, int height) {
  constexpr double kSteps = 8;
  const double larger =
      std::min(width / (screen_scale * kUsualWidth_px), height / (screen_scale * kUsualHeight_px));
  return screen_scale * std::max(1.0, std::floor(kSteps * larger) / kSteps);
}

Layout lay_out(int width, int height, double scale, const Shown& shown) {
  const double w = std::max(width, 1), h = std::max(height, 1);
  const double left = std::clamp(w - kControls_px * scale, w / 3, kLeft * w);
  const double gap = kGap_px * scale / 2;
  const bool has_plots = kPlots * h >= kPlotHeight_px * scale;
  const bool has_speed = shown.speed && 0.29 * left >= kPlotWidth_px * scale;
  const double status_y = h - std::min(kStatus_px * scale, kStatusMost * h);
  const double plots_y = status_y - (has_plots ? kPlots * h : 0);
  const double timeline_most = (has_plots ? kTimelineMost : kTimelineAlone) * h;
  const double timeline_y =
      plots_y - std::max(kTimeline * h, std::min(kTimeline_px * scale, timeline_most));
  const Rect whole = Rect{0, 0, w, h}.inset(gap);
  const auto place = [&](double x, double y, double right_x, double bottom_y) {
    // The margin surrounds the whole window.
    const double x0 = std::max(x, whole.x), y0 = std::max(y, whole.y);
    return Rect{x0, y0, std::max(std::min(right_x, whole.right()) - x0, 0.0),
                std::max(std::min(bottom_y, whole.bottom()) - y0, 0.0)}
        .inset(gap);
  };
  Layout layout;
  layout.picture = place(0, 0, left, timeline_y);
  layout.timeline = place(0, timeline_y, left, plots_y);
  if (has_plots) layout.force = place(0, plots_y, has_speed ? 0.42 * left : left, status_y);
  if (has_plots && has_speed) {
    layout.speed = place(0.42 * left, plots_y, 0.71 * left, status_y);
    layout.gain = place(0.71 * left, plots_y, left, status_y);
  }
  layout.status = place(0, status_y, left, h);
  const bool has_grip = shown.grip && kGrip * h >= kGripHeight_px * scale;
  const bool has_tensions = shown.tensions && kTensions * h >= kTensionsHeight_px * scale;
  const double tensions_y = has_grip ? kGrip * h : 0;
  const double controls_y = tensions_y + (has_tensions ? kTensions * h : 0);
  if (has_grip) layout.grip = place(left, 0, w, tensions_y);
  if (has_tensions) layout.tensions = place(left, tensions_y, w, controls_y);
  layout.controls = place(left, controls_y, w, h);
  return layout;
}

PictureMap map_picture(const Rect& panel, double frame_x, double frame_y, double frame_width,
                       double frame_height, double pixel_aspect) {
  PictureMap map;
  map.shown = fit(panel, frame_width * pixel_aspect / frame_height);
  map.frame_x = frame_x;
  map.frame_y = frame_y;
  map.scale_x = map.shown.width / frame_width;
  map.scale_y = map.shown.height / frame_height;
  return map;
}

GripProjection::GripProjection(const Rect& panel, const StringGeometry& geometry)
    : centre_px_(panel.x + panel.width / 2, panel.y + panel.height / 2) {
  constexpr double kMin_m = 1e-3;
  Eigen::Vector2d reach_m(kMin_m, kMin_m);
  for (int i = 0; i < geometry.count; ++i) {
    reach_m = reach_m.cwiseMax(flat_m(geometry.exit_m[static_cast<size_t>(i)]).cwiseAbs());
  }
  px_m_ = kFilled / 2 * std::min(panel.width / reach_m.x(), panel.height / reach_m.y());
}

Eigen::Vector2d GripProjection::flat_m(const Eigen::Vector3d& at_m) {
  // The viewer is to the right and above: near objects (z > 0) are drawn to the left and down.
  const double x = std::cos(kTurn) * at_m.x() - std::sin(kTurn) * at_m.z();
  const double z = std::sin(kTurn) * at_m.x() + std::cos(kTurn) * at_m.z();
  return {x, -(std::cos(kTilt) * at_m.y() - std::sin(kTilt) * z)};
}

Eigen::Vector2d GripProjection::operator()(const Eigen::Vector3d& at_m) const {
  return centre_px_ + px_m_ * flat_m(at_m);
}

}  // namespace spidar::window
