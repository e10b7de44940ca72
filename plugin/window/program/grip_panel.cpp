// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <string>

#include "core/force/motion_rendering.h"
#include "plugin/window/program/panels.h"
#include "plugin/window/program/plot.h"
#include "spidar/text.h"

namespace spidar::window {
namespace {

constexpr ImU32 kGripColor = IM_COL32(88, 97, 116, 255);
/// The length of the largest force, as a fraction of the panel's smaller side.
constexpr double kForceFraction = 0.3;

constexpr ImU32 kRangeColor = IM_COL32(38, 43, 53, 255);
/// Half of the width of a string's bar, as a fraction of its space.
constexpr double kHalfBar = 0.25;
/// The end of the axis where a device reports nothing of its motors.
constexpr double kLeastTension_N = 0.1;

double fraction_of_range(const DeviceView& device, int string) {
  const double low_N = device.min_tension_N[string], high_N = device.max_tension_N[string];
  return high_N > low_N ? (device.last.tension_N[string] - low_N) / (high_N - low_N) : 0;
}

/// Maps points and lengths of the grip to the screen.
struct GripView {
  const Brush& brush;
  const GripProjection& project;
  Pose pose;
  double radius_m;

  ImVec2 at(const Eigen::Vector3d& in_grip_m) const {
    return im(project(pose.position_m + pose.orientation * in_grip_m));
  }
  float px(double length_m) const {
    const Eigen::Vector3d tip_m = pose.position_m + Eigen::Vector3d(0, length_m, 0);
    return static_cast<float>((project(tip_m) - project(pose.position_m)).norm());
  }
};

/// Draws the ball that the hand holds, and the rods to which the strings are tied.
void draw_grip_body(const GripView& view, const DeviceView& device) {
  const ImVec2 centre = view.at(Eigen::Vector3d::Zero());
  for (int i = 0; device.has_strings && i < device.geometry.count; ++i) {
    const ImVec2 end = view.at(device.geometry.grip_m[static_cast<size_t>(i)]);
    view.brush.list.AddLine(centre, end, kTextColor, view.brush.px(2.5));
    view.brush.list.AddCircleFilled(end, view.brush.px(3), kTextColor);
  }
  const float radius = view.px(0.55 * view.radius_m);
  view.brush.list.AddCircleFilled(centre, radius, kGripColor, 32);
  view.brush.list.AddCircle(centre, radius, kTextColor, 32, view.brush.px(1));
}

void draw_strings(const Brush& brush, const GripProjection& project, const DeviceView& device) {
  const TickRecord& last = device.last;
  const Eigen::Matrix3d R = last.pose.orientation.toRotationMatrix();
  for (int i = 0; i < device.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const double fraction = fraction_of_range(device, i);
    const ImU32 color = i == last.faulty_string ? kWarnColor : kAccentColor;
    const Eigen::Vector2d exit = project(device.geometry.exit_m[k]);
    brush.list.AddLine(im(exit), im(project(last.pose.position_m + R * device.geometry.grip_m[k])),
                       color, brush.px(1.2 + 2.5 * std::clamp(fraction, 0.0, 1.0)));
    brush.list.AddCircleFilled(im(exit), brush.px(3.5), kTextColor);
    // The number of the string is beside its exit.
    const std::string number = std::to_string(i);
    const ImVec2 size = text_size(brush.fonts.small, number);
    const double side = exit.x() < project(Eigen::Vector3d::Zero()).x() ? -1 : 1;
    draw_text(brush, brush.fonts.small,
              im(exit.x() + side * 12 * brush.scale - size.x / 2, exit.y() - size.y / 2),
              kMutedColor, number);
  }
}

/// Draws a force at the hand, as a line in space, with its newtons and the name `which`, within the
/// panel. Without a name the line is faint.
void draw_force(const GripView& view, const Rect& panel, const Wrench& wrench, double most_N,
                const char* which) {
  const double force_N = wrench.force_N.norm();
  if (force_N < kFeltForce_N || most_N <= 0) return;
  const Eigen::Vector2d from = view.project(view.pose.position_m);
  const Eigen::Vector2d direction =
      (view.project(view.pose.position_m + wrench.force_N / force_N * view.radius_m) - from) /
      view.px(view.radius_m);
  const double length =
      kForceFraction * std::min(panel.width, panel.height) * std::min(force_N / most_N, 1.0);
  const Eigen::Vector2d to = from + length * direction;
  const Brush& brush = view.brush;
  const Eigen::Vector2d along = (to - from).normalized(), side(-along.y(), along.x());
  const double head = (which ? 9 : 14) * brush.scale;
  const ImU32 color = which ? kFeltColor : faded(kTextColor, 95);
  brush.list.AddLine(im(from), im(to), color, brush.px(which ? 3.5 : 7));
  brush.list.AddTriangleFilled(im(to + head * along), im(to + 0.6 * head * side),
                               im(to - 0.6 * head * side), color);
  if (!which) return;
  const std::string text = formatted("%.1f N%s", force_N, which);
  const ImVec2 text_px = text_size(brush.fonts.bold, text);
  const Eigen::Vector2d size(text_px.x + brush.px(10), text_px.y + brush.px(4));
  const Eigen::Vector2d low(panel.x, panel.y), high(panel.right(), panel.bottom());
  Eigen::Vector2d corner = to + 2.2 * head * along - Eigen::Vector2d(0, size.y() / 2);
  if (along.x() < 0) corner.x() -= size.x();
  draw_label(brush, brush.fonts.bold, im(corner.cwiseMin(high - size).cwiseMax(low)), kFeltColor,
             text);
}

void draw_compass(const Brush& brush, const Rect& panel, const GripProjection& project) {
  const double length = std::min(20 * brush.scale, 0.14 * panel.height);
  const double name = text_size(brush.fonts.small, kAxisNames[2]).x;  // to the left
  const Eigen::Vector2d corner(panel.x + std::max(2.4 * length, name + length),
                               panel.bottom() - 0.7 * length);
  const Eigen::Vector2d origin = project(Eigen::Vector3d::Zero());
  const double unit = (project(Eigen::Vector3d::UnitY()) - origin).norm();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d along = (project(Eigen::Vector3d::Unit(axis)) - origin) / unit;
    const Eigen::Vector2d tip = corner + length * along;
    brush.list.AddLine(im(corner), im(tip), kAxisColors[axis], brush.px(2));
    const ImFont* const font = brush.fonts.small;
    const double gap = 3 * brush.scale, y = tip.y() - font->FontSize / 2;
    if (along.x() < 0) {
      draw_text_before(brush, font, im(tip.x() - gap, y), kAxisColors[axis], kAxisNames[axis]);
    } else {
      draw_text(brush, font, im(tip.x() + gap, y), kAxisColors[axis], kAxisNames[axis]);
    }
  }
}

}  // namespace

void draw_grip(const Brush& brush, const Rect& panel, const DeviceView& device, bool is_as_asked) {
  const TickRecord& last = device.last;
  std::string note = device.name + ", " + to_string(last.device);
  if (last.faulty_string >= 0) {
    note += ", string " + std::to_string(last.faulty_string) + " at fault";
  }
  const Rect content = draw_panel(brush, panel, "Grip", note);
  // Lengths in an empty panel are zero, and the code below divides by them.
  if (content.width <= 0 || content.height <= 0) return;
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  const GripProjection project(content, device.geometry);
  const GripView view{brush, project, last.pose, device.geometry.grip_radius_m()};
  draw_compass(brush, content, project);
  if (device.has_strings) draw_strings(brush, project, device);
  draw_grip_body(view, device);
  draw_force(view, content, last.wanted, last.max_force_N, nullptr);
  draw_force(view, content, last.delivered, last.max_force_N, is_as_asked ? "" : " delivered");
  brush.list.PopClipRect();
}

void draw_tensions(const Brush& brush, const Rect& panel, const DeviceView& device) {
  const Rect content = draw_panel(brush, panel, "String tensions", "N");
  if (device.geometry.count == 0) return;
  const int count = device.geometry.count;
  const double most_N = std::max(device.max_tension_N.head(count).maxCoeff(), kLeastTension_N);
  const PlotAxis strings_axis = make_axis(-0.5, count - 0.5, count);
  const Plot plot(brush, content, strings_axis,
                  make_axis(0, most_N, Plot::steps_up(brush, content.height)), "", "");
  const ImFont* font = brush.fonts.small;
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  for (int i = 0; i < count; ++i) {
    const double tension_N = device.last.tension_N[i], range_N = device.max_tension_N[i];
    const auto fill = [&](double to_N, ImU32 color) {
      const double top_N = std::clamp(to_N, 0.0, range_N);
      brush.list.AddRectFilled(plot.at(i - kHalfBar, top_N), plot.at(i + kHalfBar, 0), color);
    };
    fill(range_N, kRangeColor);
    fill(tension_N, device.last.faulty_string == i ? kWarnColor : kAccentColor);
    const double least_N = device.min_tension_N[i];
    brush.list.AddLine(plot.at(i - 1.2 * kHalfBar, least_N), plot.at(i + 1.2 * kHalfBar, least_N),
                       kTextColor);
    const std::string value = formatted("%.1f", tension_N);
    const ImVec2 top = plot.at(i, most_N);
    if (text_size(font, value).x > plot.area().width / count) continue;
    draw_text(brush, font, {top.x - text_size(font, value).x / 2, top.y - font->FontSize - 2},
              kTextColor, value);
  }
  brush.list.PopClipRect();
}

}  // namespace spidar::window
