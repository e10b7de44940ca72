// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace spidar {
namespace {

/// Of height to width, from which on the panels are stacked.
constexpr double kTall = 1.1;
// Shares of the window.
constexpr double kLeft = 0.66, kGrip = 0.27, kTensions = 0.18, kObjects = 0.2;
constexpr double kTimeline = 0.13, kPlots = 0.23;
// The same where they are stacked: below kLower are device and settings.
constexpr double kTallTimeline = 0.1, kTallPlots = 0.18, kLower = 0.64, kTallTensions = 0.14;
constexpr double kTallObjects = 0.13;
/// Of text, in pixels at a scale of 1; a share of the window at most.
constexpr double kStatus_px = 34, kStatusMost = 0.1;
/// The title, the button, a line and the film below each other; a share of the window at most.
constexpr double kTimeline_px = 96, kTimelineMost = 0.2;
constexpr double kGap_px = 8;

// Of the view: turned about y, then tilted, radians.
constexpr double kTurn = 0.4, kTilt = 0.3;
/// Of the panel, for the exits of the strings; the rest is for their numbers.
constexpr double kFilled = 0.8;

// Of the list of objects, in pixels at a scale of 1: a picture with a name beside it.
// It grows with the panel.
constexpr double kName_px = 46, kRowHeight_px = 28, kMostRowHeight_px = 44, kRowGap_px = 3;
constexpr double kRowPicture = 4.0 / 3;  // width of the picture over the height of the row
constexpr double kRowShare = 0.36, kListMargin_px = 10, kListTitle_px = 24;

/// Of the room of a string's bar.
constexpr double kBarFilled = 0.5;

}  // namespace

Rect fit(const Rect& outer, double aspect) {
  const double width = std::min(outer.width, outer.height * aspect);
  const double height = width / aspect;
  return {outer.x + (outer.width - width) / 2, outer.y + (outer.height - height) / 2, width,
          height};
}

WindowLayout lay_out(int width, int height, double scale) {
  const double w = std::max(width, 1), h = std::max(height, 1);
  const bool tall = h > kTall * w;
  const double left = tall ? w : kLeft * w, gap = kGap_px * scale / 2;
  const double status_y = h - std::min(kStatus_px * scale, kStatusMost * h);
  const double lower_y = tall ? kLower * h : status_y;
  const double plots_y = lower_y - (tall ? kTallPlots : kPlots) * h;
  const double timeline_y = plots_y - std::max((tall ? kTallTimeline : kTimeline) * h,
                                               std::min(kTimeline_px * scale, kTimelineMost * h));
  const Rect whole = Rect{0, 0, w, h}.inset(gap);
  const auto place = [&](double x, double y, double right_x, double bottom_y) {
    // Within the margin around all.
    const double x0 = std::max(x, whole.x), y0 = std::max(y, whole.y);
    return Rect{x0, y0, std::max(std::min(right_x, whole.right()) - x0, 0.0),
                std::max(std::min(bottom_y, whole.bottom()) - y0, 0.0)}
        .inset(gap);
  };
  WindowLayout layout;
  layout.picture = place(0, 0, left, timeline_y);
  layout.timeline = place(0, timeline_y, left, plots_y);
  layout.force = place(0, plots_y, 0.42 * left, lower_y);
  layout.speed = place(0.42 * left, plots_y, 0.71 * left, lower_y);
  layout.gain = place(0.71 * left, plots_y, left, lower_y);
  layout.status = place(0, status_y, left, h);
  if (tall) {
    const double tensions_y = status_y - kTallTensions * h;
    layout.grip = place(0, lower_y, w / 2, tensions_y);
    layout.tensions = place(0, tensions_y, w / 2, status_y);
    const double objects_y = lower_y + kTallObjects * h;
    layout.objects = place(w / 2, lower_y, w, objects_y);
    layout.controls = place(w / 2, objects_y, w, status_y);
    return layout;
  }
  const double tensions_y = kGrip * h, objects_y = tensions_y + kTensions * h;
  const double controls_y = objects_y + kObjects * h;
  layout.grip = place(left, 0, w, tensions_y);
  layout.tensions = place(left, tensions_y, w, objects_y);
  layout.objects = place(left, objects_y, w, controls_y);
  layout.controls = place(left, controls_y, w, h);
  return layout;
}

std::vector<Rect> object_rows(const Rect& panel, double scale, size_t count) {
  const double gap = kRowGap_px * scale;
  Rect room = panel.inset(kListMargin_px * scale);
  room.height = std::max(panel.bottom() - gap - panel.y - kListTitle_px * scale, 0.0);
  room.y = panel.y + kListTitle_px * scale;
  const double height =
      std::clamp(kRowShare * room.height, kRowHeight_px * scale, kMostRowHeight_px * scale);
  const auto fitting = [&](double length, double one) {
    return static_cast<size_t>(std::max((length + gap) / (one + gap), 0.0));
  };
  const size_t columns =
      std::max<size_t>(fitting(room.width, kRowPicture * height + kName_px * scale), 1);
  const size_t shown = std::min(count, columns * fitting(room.height, height));
  const double width = (room.width + gap) / static_cast<double>(columns) - gap;
  std::vector<Rect> rows;
  for (size_t i = 0; i < shown; ++i) {
    rows.push_back({room.x + static_cast<double>(i % columns) * (width + gap),
                    room.y + static_cast<double>(i / columns) * (height + gap), width, height});
  }
  return rows;
}

Rect row_picture(const Rect& row, double aspect) {
  const Rect room = Rect{row.x, row.y, kRowPicture * row.height, row.height}.inset(row.height / 16);
  return fit(room, aspect);
}

std::optional<Rect> place_label(const Rect& panel, const Rect& wanted,
                                const std::vector<Rect>& taken) {
  constexpr int kSteps = 16;
  const double across = std::max(panel.width - wanted.width, 0.0);
  const double down = std::max(panel.height - wanted.height, 0.0);
  const auto at = [&](double x, double y) {
    return Rect{std::clamp(x, panel.x, panel.x + across), std::clamp(y, panel.y, panel.y + down),
                wanted.width, wanted.height};
  };
  const auto is_free = [&](const Rect& place) {
    return std::none_of(taken.begin(), taken.end(),
                        [&](const Rect& other) { return place.overlaps(other); });
  };
  const Rect first = at(wanted.x, wanted.y);
  if (is_free(first)) return first;
  std::optional<Rect> best;
  double nearest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      const Rect place = at(panel.x + i * across / kSteps, panel.y + k * down / kSteps);
      const double distance = std::hypot(place.x - first.x, place.y - first.y);
      if ((best && distance >= nearest) || !is_free(place)) continue;
      best = place;
      nearest = distance;
    }
  }
  return best;
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
  constexpr double kLeast_m = 1e-3;
  Eigen::Vector2d reach_m(kLeast_m, kLeast_m);
  for (int i = 0; i < geometry.count; ++i) {
    reach_m = reach_m.cwiseMax(flat_m(geometry.exit_m[static_cast<size_t>(i)]).cwiseAbs());
  }
  px_m_ = kFilled / 2 * std::min(panel.width / reach_m.x(), panel.height / reach_m.y());
}

Eigen::Vector2d GripProjection::flat_m(const Eigen::Vector3d& at_m) {
  // The viewer goes to the right and up: near things (z > 0) go to the left and down.
  const double x = std::cos(kTurn) * at_m.x() - std::sin(kTurn) * at_m.z();
  const double z = std::sin(kTurn) * at_m.x() + std::cos(kTurn) * at_m.z();
  return {x, -(std::cos(kTilt) * at_m.y() - std::sin(kTilt) * z)};
}

Eigen::Vector2d GripProjection::operator()(const Eigen::Vector3d& at_m) const {
  return centre_px_ + px_m_ * flat_m(at_m);
}

Rect tension_area(const Rect& panel, double scale) {
  constexpr double kAbove_px = 46, kLeft_px = 34, kBelow_px = 38, kRight_px = 10;
  const double left = std::min(kLeft_px * scale, panel.width / 4);
  const double above = std::min(kAbove_px * scale, panel.height / 3);
  const double right = std::min(kRight_px * scale, panel.width / 4);
  const double below = std::min(kBelow_px * scale, panel.height / 3);
  return {panel.x + left, panel.y + above, panel.width - left - right,
          panel.height - above - below};
}

std::vector<TensionBar> tension_bars(const Rect& area, const DeviceView& device) {
  std::vector<TensionBar> bars;
  const double room = area.width / std::max(device.geometry.count, 1), width = kBarFilled * room;
  for (int i = 0; i < device.geometry.count; ++i) {
    TensionBar bar;
    bar.range = {area.x + i * room + (room - width) / 2, area.y, width, area.height};
    const double most_N = device.max_tension_N[i];
    const auto share = [&](double tension_N) {
      return most_N > 0 ? std::clamp(tension_N / most_N, 0.0, 1.0) : 0.0;
    };
    const double filled = share(device.last.tension_N[i]) * area.height;
    bar.filled = {bar.range.x, bar.range.bottom() - filled, width, filled};
    bar.least_y = bar.range.bottom() - share(device.min_tension_N[i]) * area.height;
    bars.push_back(bar);
  }
  return bars;
}

}  // namespace spidar
