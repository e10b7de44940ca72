// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>

#include "plugin/window/panels.h"

namespace spidar {
namespace {

constexpr std::array<ImU32, 3> kAxisColor{IM_COL32(240, 80, 80, 255), IM_COL32(90, 220, 90, 255),
                                          IM_COL32(90, 140, 255, 255)};

/// Blue at the smallest tension, red at the largest.
ImU32 tension_color(double share) {
  const auto warm = static_cast<int>(255 * std::clamp(share, 0.0, 1.0));
  return IM_COL32(warm, 120, 255 - warm, 255);
}

void draw_grip_body(const Brush& brush, const GripProjection& project, const DeviceView& device) {
  const Pose& pose = device.loop.last.pose;
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  const ImVec2 centre = im(project(pose.position_m));
  const auto thick = static_cast<float>(3 * brush.scale);
  for (int i = 0; i < device.geometry.count; ++i) {
    const Eigen::Vector3d at_m =
        pose.position_m + R * device.geometry.grip_m[static_cast<size_t>(i)];
    brush.list.AddLine(centre, im(project(at_m)), kTextColor, thick);
  }
  // Its axes, half its radius long beyond the body.
  const double length_m = 1.5 * device.geometry.grip_radius_m();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d tip_m = pose.position_m + length_m * R.col(axis);
    brush.list.AddLine(centre, im(project(tip_m)), kAxisColor[static_cast<size_t>(axis)],
                       static_cast<float>(1.5 * brush.scale));
  }
}

void draw_strings(const Brush& brush, const GripProjection& project, const DeviceView& device) {
  const TickRecord& last = device.loop.last;
  const Eigen::Matrix3d R = last.pose.orientation.toRotationMatrix();
  for (int i = 0; i < device.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const double low_N = device.min_tension_N[i], high_N = device.max_tension_N[i];
    const double share = high_N > low_N ? (last.tension_N[i] - low_N) / (high_N - low_N) : 0;
    const ImU32 color = i == last.faulty_string ? kWarnColor : tension_color(share);
    brush.list.AddCircleFilled(im(project(device.geometry.exit_m[k])),
                               static_cast<float>(2.5 * brush.scale), kTextColor);
    brush.list.AddLine(im(project(device.geometry.exit_m[k])),
                       im(project(last.pose.position_m + R * device.geometry.grip_m[k])), color,
                       static_cast<float>((1 + 2 * std::clamp(share, 0.0, 1.0)) * brush.scale));
  }
}

}  // namespace

void draw_grip(const Brush& brush, const Rect& panel, const ElementState& state) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor);
  const ImVec2 title = im(panel.x + 6 * brush.scale, panel.y + 4 * brush.scale);
  if (!state.device) {
    brush.list.AddText(title, kTextColor, "no device open");
    return;
  }
  const DeviceView& device = *state.device;
  const TickRecord& last = device.loop.last;
  const std::string text =
      device.name + ": " + to_string(last.device) +
      (last.faulty_string >= 0 ? ", string " + std::to_string(last.faulty_string) + " at fault"
                               : "");
  brush.list.AddText(title, last.device == DeviceState::kLost ? kWarnColor : kTextColor,
                     text.c_str());
  const GripProjection project(panel, device.geometry);
  draw_strings(brush, project, device);
  draw_grip_body(brush, project, device);
  const std::vector<TensionBar> bars = tension_bars(project, device, brush.scale);
  for (size_t i = 0; i < bars.size(); ++i) {
    const TensionBar& bar = bars[i];
    brush.list.AddRectFilled(upper_left(bar.filled), lower_right(bar.filled), kBarColor);
    brush.list.AddRect(upper_left(bar.range), lower_right(bar.range), kLineColor);
    brush.list.AddLine(im(bar.range.x, bar.least_y), im(bar.range.right(), bar.least_y),
                       kTextColor);
    char value[16];
    std::snprintf(value, sizeof value, "%.1f", last.tension_N[static_cast<Eigen::Index>(i)]);
    brush.list.AddText(im(bar.range.x - 6 * brush.scale, bar.range.bottom() + 1), kTextColor,
                       value);
  }
}

}  // namespace spidar
