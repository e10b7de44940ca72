// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/layout.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

// Shares of the window.
constexpr double kLeft = 0.62, kPicture = 0.64, kPlots = 0.24, kGrip = 0.42, kGain = 0.2;
constexpr double kGap_px = 6;

// Of the view: turned about y, then tilted, radians.
constexpr double kTurn = 0.4, kTilt = 0.3;
/// Of the panel's smaller side, for the sphere around the exits; the rest is for the bars.
constexpr double kFilled = 0.8;

constexpr double kBarWidth_px = 7, kBarHeight_px = 44;

}  // namespace

Rect Rect::inset(double margin) const {
  const double dx = std::min(margin, width / 2), dy = std::min(margin, height / 2);
  return {x + dx, y + dy, width - 2 * dx, height - 2 * dy};
}

Rect fit(const Rect& outer, double aspect) {
  const double width = std::min(outer.width, outer.height * aspect);
  const double height = width / aspect;
  return {outer.x + (outer.width - width) / 2, outer.y + (outer.height - height) / 2, width,
          height};
}

WindowLayout lay_out(int width, int height, double scale) {
  const double w = std::max(width, 1), h = std::max(height, 1);
  const double left = kLeft * w, right = w - left, gap = kGap_px * scale / 2;
  const double plots_y = kPicture * h, status_y = plots_y + kPlots * h;
  const double gain_y = kGrip * h, controls_y = gain_y + kGain * h;
  WindowLayout layout;
  layout.picture = Rect{0, 0, left, plots_y}.inset(gap);
  layout.force = Rect{0, plots_y, left / 2, status_y - plots_y}.inset(gap);
  layout.speed = Rect{left / 2, plots_y, left / 2, status_y - plots_y}.inset(gap);
  layout.status = Rect{0, status_y, left, h - status_y}.inset(gap);
  layout.grip = Rect{left, 0, right, gain_y}.inset(gap);
  layout.gain = Rect{left, gain_y, right, controls_y - gain_y}.inset(gap);
  layout.controls = Rect{left, controls_y, right, h - controls_y}.inset(gap);
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
  double reach_m = 1e-3;
  for (int i = 0; i < geometry.count; ++i) {
    reach_m = std::max(reach_m, geometry.exit_m[static_cast<size_t>(i)].norm());
  }
  px_m_ = kFilled * std::min(panel.width, panel.height) / 2 / reach_m;
}

Eigen::Vector2d GripProjection::operator()(const Eigen::Vector3d& at_m) const {
  // The viewer goes to the right and up: near things (z > 0) go to the left and down.
  const double x = std::cos(kTurn) * at_m.x() - std::sin(kTurn) * at_m.z();
  const double z = std::sin(kTurn) * at_m.x() + std::cos(kTurn) * at_m.z();
  const double y = std::cos(kTilt) * at_m.y() - std::sin(kTilt) * z;
  return centre_px_ + px_m_ * Eigen::Vector2d(x, -y);
}

std::vector<TensionBar> tension_bars(const GripProjection& project, const DeviceView& device,
                                     double scale) {
  std::vector<TensionBar> bars;
  const double width = kBarWidth_px * scale, height = kBarHeight_px * scale;
  const Eigen::Vector2d centre_px = project(Eigen::Vector3d::Zero());
  for (int i = 0; i < device.geometry.count; ++i) {
    const Eigen::Vector2d exit_px = project(device.geometry.exit_m[static_cast<size_t>(i)]);
    // Outside of the frame, level with the exit.
    const double x = exit_px.x() < centre_px.x() ? exit_px.x() - 2 * width : exit_px.x() + width;
    TensionBar bar;
    bar.range = {x, exit_px.y() - height / 2, width, height};
    const double most_N = device.max_tension_N[i];
    const auto share = [&](double tension_N) {
      return most_N > 0 ? std::clamp(tension_N / most_N, 0.0, 1.0) : 0.0;
    };
    const double filled = share(device.loop.last.tension_N[i]) * height;
    bar.filled = {x, bar.range.bottom() - filled, width, filled};
    bar.least_y = bar.range.bottom() - share(device.min_tension_N[i]) * height;
    bars.push_back(bar);
  }
  return bars;
}

}  // namespace spidar
