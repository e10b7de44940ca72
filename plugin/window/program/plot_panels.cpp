// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <optional>

#include "core/wrench_size.h"
#include "plugin/window/program/panels.h"
#include "plugin/window/program/plot.h"
#include "spidar/text.h"

namespace spidar::window {
namespace {

constexpr double kMinSpeed_px_s = 100, kHeadroom = 1.1;
constexpr int kCurvePoints = 64;

/// The last seconds, as seconds before the newest moment.
PlotAxis time_axis(const Brush& brush, const Rect& panel, const Timeline& timeline) {
  return make_axis(-timeline.plotted_s(), 0, Plot::steps_across(brush, panel.width));
}

template <typename Value>
std::vector<Eigen::Vector2d> series(const Timeline& timeline, const Value& value) {
  std::vector<Eigen::Vector2d> points;
  for (const Moment& moment : timeline.plotted()) {
    points.emplace_back(moment.time_s - timeline.newest_s(), value(moment));
  }
  return points;
}

std::vector<PlotSpan> spans(const std::vector<ForceColumn>& columns, Eigen::Index axis,
                            Eigen::Vector3d ForceColumn::*low_N,
                            Eigen::Vector3d ForceColumn::*high_N) {
  std::vector<PlotSpan> all;
  for (const ForceColumn& column : columns) {
    all.push_back({column.is_empty, (column.*low_N)[axis], (column.*high_N)[axis]});
  }
  return all;
}

/// Shows, beside the mouse, the largest delivered force in this pixel's width.
void show_force_tooltip(double at_s, const ForceColumn& column) {
  if (column.is_empty) return;
  std::string text = formatted("%.2f s: %.2f N", at_s, column.most_N);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low_N = column.delivered_low_N[axis], high_N = column.delivered_high_N[axis];
    const double largest_N = -low_N > high_N ? low_N : high_N;
    text += formatted("\n%s %+.2f N", kAxisNames[axis], largest_N);
  }
  ImGui::SetTooltip("%s", text.c_str());
}

double largest_N(const std::vector<ForceColumn>& columns) {
  double largest_N = 0;
  for (const ForceColumn& column : columns) {
    if (column.is_empty) continue;
    for (const auto& force_N : {column.wanted_low_N, column.wanted_high_N, column.delivered_low_N,
                                column.delivered_high_N}) {
      largest_N = std::max(largest_N, force_N.cwiseAbs().maxCoeff());
    }
  }
  return largest_N;
}

/// The end of an axis of speed, which fits the plotted data in spite of outliers.
double highest_speed_px_s(const Timeline& timeline) {
  std::vector<double> speeds_px_s;
  for (const Moment& moment : timeline.plotted()) speeds_px_s.push_back(moment.speed_px_s);
  return std::max(kHeadroom * robust_largest(std::move(speeds_px_s)), kMinSpeed_px_s);
}

/// Shades the speeds whose force is weaker than kFeltForce_N. For `adaptive`, the dead zone is
/// that of an unknown error, not of the error of each frame.
void shade_unfelt(const Brush& brush, const Plot& plot, const std::vector<double>& curve_N,
                  double highest_px_s) {
  const auto felt = std::find_if(curve_N.begin(), curve_N.end(),
                                 [](double force_N) { return force_N >= kFeltForce_N; });
  if (felt == curve_N.begin()) return;
  const double share = static_cast<double>(felt - curve_N.begin()) / (kCurvePoints - 1);
  const Rect& area = plot.area();
  const ImVec2 low = plot.at(std::min(share, 1.0) * highest_px_s, 0);
  brush.list.AddRectFilled(upper_left(area), {low.x, static_cast<float>(area.bottom())},
                           faded(kTextColor, 28));
}

}  // namespace

void draw_force(const Brush& brush, const Rect& panel, const Timeline& timeline) {
  const std::vector<Moment> moments = timeline.plotted();
  std::string note;
  if (!moments.empty()) {
    const Wrench& felt = moments.back().felt;
    note = formatted("%.2f N, %.0f mN m", felt.force_N.norm(), 1e3 * felt.torque_Nm.norm());
  }
  const Rect content = draw_panel(brush, panel, "Force", note);
  const double end_s = timeline.newest_s(), begin_s = end_s - timeline.plotted_s();
  const auto pixels = static_cast<size_t>(std::max(content.width, 1.0));
  const std::vector<ForceColumn> columns = timeline.columns(begin_s, end_s, pixels);
  const double most_N = force_axis_end_N(largest_N(columns));
  const PlotAxis y = make_axis(-most_N, most_N, Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, time_axis(brush, content, timeline), y, "s", "N");
  for (Eigen::Index axis = 2; axis >= 0; --axis) {
    const ImU32 color = kAxisColors[axis];
    plot.band(spans(columns, axis, &ForceColumn::wanted_low_N, &ForceColumn::wanted_high_N),
              faded(color, 95), 3.5);
    plot.band(spans(columns, axis, &ForceColumn::delivered_low_N, &ForceColumn::delivered_high_N),
              color);
  }
  if (const std::optional<double> at_s = plot.hovered_x()) {
    const double fraction = 1 + *at_s / timeline.plotted_s();
    const auto column = static_cast<size_t>(fraction * static_cast<double>(columns.size()));
    if (column < columns.size()) show_force_tooltip(*at_s, columns[column]);
  }
  plot.legend({{kAxisNames[0], kAxisColors[0]},
               {kAxisNames[1], kAxisColors[1]},
               {kAxisNames[2], kAxisColors[2]},
               {"wanted", faded(kTextColor, 95)},
               {"delivered", kTextColor}});
}

void draw_speed(const Brush& brush, const Rect& panel, const Timeline& timeline) {
  const std::vector<Moment> moments = timeline.plotted();
  const Rect content =
      draw_panel(brush, panel, "Speed",
                 moments.empty() ? "" : formatted("%.0f px/s", moments.back().speed_px_s));
  const PlotAxis y =
      make_axis(0, highest_speed_px_s(timeline), Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, time_axis(brush, content, timeline), y, "s", "px/s at 480 lines");
  const std::vector<Eigen::Vector2d> speed =
      series(timeline, [](const Moment& m) { return m.speed_px_s; });
  plot.line(speed, kSpeedColor);
  const std::optional<double> at_s = plot.hovered_x();
  if (!at_s) return;
  const auto after = std::find_if(speed.begin(), speed.end(),
                                  [&](const Eigen::Vector2d& point) { return point.x() >= *at_s; });
  if (after != speed.end()) ImGui::SetTooltip("%.2f s: %.0f px/s", after->x(), after->y());
}

void draw_gain(const Brush& brush, const Rect& panel, const Timeline& timeline,
               const ControllerSettings& controller, const SettingsComparison& settings) {
  const Rect content = draw_panel(brush, panel, "Speed to force");
  const double highest_px_s = highest_speed_px_s(timeline);
  const ControllerSettings other = with_values(controller, settings.other());
  const std::vector<double> used_N = timeline.gain_curve(controller, highest_px_s, kCurvePoints),
                            other_N = timeline.gain_curve(other, highest_px_s, kCurvePoints);
  double highest_N = 0;
  for (const std::vector<double>* const curve_N : {&used_N, &other_N}) {
    for (const double force_N : *curve_N) highest_N = std::max(highest_N, force_N);
  }
  const double most_N = force_axis_end_N(highest_N);
  const int steps = std::max(2, Plot::steps_across(brush, content.width));
  const PlotAxis x = make_axis(0, highest_px_s, steps);
  const PlotAxis y = make_axis(0, most_N, Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, x, y, "px/s", "N");
  const auto draw_curve = [&](const std::vector<double>& curve_N, ImU32 color) {
    std::vector<Eigen::Vector2d> curve;
    for (size_t i = 0; i < curve_N.size(); ++i) {
      curve.emplace_back(highest_px_s * static_cast<double>(i) / (kCurvePoints - 1), curve_N[i]);
    }
    plot.line(curve, color);
  };
  shade_unfelt(brush, plot, used_N, highest_px_s);
  if (!settings.are_same()) {
    const bool is_first = settings.used() == 0;
    draw_curve(other_N, kMutedColor);
    plot.legend({{is_first ? "1" : "2", kSpeedColor}, {is_first ? "2" : "1", kMutedColor}});
  }
  draw_curve(used_N, kSpeedColor);
  const std::vector<Moment> moments = timeline.plotted();
  if (moments.empty()) return;
  // The controller's force, a part of which may have become torque.
  plot.dot(moments.back().speed_px_s, size_N(moments.back().wanted), kFeltColor);
}

}  // namespace spidar::window
