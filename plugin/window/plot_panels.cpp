// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cstdio>

#include "plugin/window/panels.h"

namespace spidar {
namespace {

constexpr double kLeastForce_N = 0.5, kLeastSpeed_px_s = 100;
constexpr int kCurvePoints = 64;

/// A panel with axes: x and y as shares of what is shown.
class Plot {
 public:
  Plot(const Brush& brush, const Rect& panel, const char* title) : brush_(brush) {
    brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor);
    brush.list.AddText(im(panel.x + 6 * brush.scale, panel.y + 4 * brush.scale), kTextColor, title);
    area_ = panel.inset(8 * brush.scale);
    const double text = std::min(16 * brush.scale, area_.height);
    area_.y += text;
    area_.height -= text;
    brush.list.AddRect(upper_left(area_), lower_right(area_), kLineColor);
  }

  ImVec2 at(double x, double y) const {
    return im(area_.x + std::clamp(x, 0.0, 1.0) * area_.width,
              area_.bottom() - std::clamp(y, 0.0, 1.0) * area_.height);
  }
  void line(const ImVec2* points, int count, ImU32 color) const {
    brush_.list.AddPolyline(points, count, color, 0, static_cast<float>(1.5 * brush_.scale));
  }
  void level(double y, ImU32 color) const { brush_.list.AddLine(at(0, y), at(1, y), color); }
  void dot(double x, double y, ImU32 color) const {
    brush_.list.AddCircleFilled(at(x, y), static_cast<float>(4 * brush_.scale), color);
  }

 private:
  const Brush& brush_;
  Rect area_;
};

/// One quantity of the history over its time, `highest` at the top.
void draw_series(const Plot& plot, const MotionHistory& history, double Moment::*value,
                 double highest, ImU32 color) {
  if (history.moments().empty()) return;
  const double newest_s = history.moments().back().time_s;
  std::vector<ImVec2> points;
  points.reserve(history.moments().size());
  for (const Moment& moment : history.moments()) {
    points.push_back(plot.at(1 - (newest_s - moment.time_s) / MotionHistory::kMemory_s,
                             moment.*value / highest));
  }
  plot.line(points.data(), static_cast<int>(points.size()), color);
}

double largest(const MotionHistory& history, double Moment::*value, double least) {
  for (const Moment& moment : history.moments()) least = std::max(least, moment.*value);
  return least;
}

}  // namespace

void draw_force(const Brush& brush, const Rect& panel, const MotionHistory& history,
                double max_force_N) {
  const double felt_N = history.moments().empty() ? 0 : history.moments().back().felt_N;
  char title[64];
  std::snprintf(title, sizeof title, "force %.2f N (grey: wanted), 5 s", felt_N);
  const Plot plot(brush, panel, title);
  const double highest_N = 1.1 * std::max(max_force_N, kLeastForce_N);
  plot.level(max_force_N / highest_N, kLineColor);
  draw_series(plot, history, &Moment::wanted_N, highest_N, kWantedColor);
  draw_series(plot, history, &Moment::felt_N, highest_N, kFeltColor);
}

void draw_speed(const Brush& brush, const Rect& panel, const MotionHistory& history) {
  const double speed_px_s = history.moments().empty() ? 0 : history.moments().back().speed_px_s;
  char title[64];
  std::snprintf(title, sizeof title, "speed %.0f px/s at 480 lines, 5 s", speed_px_s);
  const Plot plot(brush, panel, title);
  draw_series(plot, history, &Moment::speed_px_s,
              1.1 * largest(history, &Moment::speed_px_s, kLeastSpeed_px_s), kSpeedColor);
}

void draw_gain(const Brush& brush, const Rect& panel, const MotionHistory& history,
               const ControllerSettings& controller) {
  const double highest_px_s = 1.1 * largest(history, &Moment::speed_px_s, kLeastSpeed_px_s);
  const double highest_N = 1.1 * std::max(controller.max_force_N, kLeastForce_N);
  char title[64];
  std::snprintf(title, sizeof title, "gain: 0 to %.0f px/s, 0 to %.1f N", highest_px_s, highest_N);
  const Plot plot(brush, panel, title);
  const std::vector<double> curve_N = gain_curve(controller, history, highest_px_s, kCurvePoints);
  std::vector<ImVec2> points;
  for (size_t i = 0; i < curve_N.size(); ++i) {
    points.push_back(plot.at(static_cast<double>(i) / (kCurvePoints - 1), curve_N[i] / highest_N));
  }
  plot.line(points.data(), static_cast<int>(points.size()), kSpeedColor);
  if (history.moments().empty()) return;
  const Moment& now = history.moments().back();
  plot.dot(now.speed_px_s / highest_px_s, now.wanted_N / highest_N, kFeltColor);
}

void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const FrameFacts& facts, const std::string& note) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor);
  char line[256];
  const double line_px = 16 * brush.scale;
  ImVec2 at = im(panel.x + 6 * brush.scale, panel.y + 4 * brush.scale);
  const auto next = [&](ImU32 color, const char* text) {
    brush.list.AddText(at, color, text);
    at.y += static_cast<float>(line_px);
  };
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  const Eigen::Vector2d& velocity = facts.scene.motion.velocity_px_s;
  std::snprintf(line, sizeof line,
                "%.2f s  analysis %.2f ms a frame  %zu tracks  %zu objects  %.0f, %.0f px/s",
                1e-9 * static_cast<double>(facts.running_ns), facts.analysis_ms,
                facts.scene.tracks.size(), facts.scene.objects.size(), velocity.x(), velocity.y());
  next(kTextColor, line);
  if (state.device) {
    const LoopSnapshot& loop = state.device->loop;
    std::snprintf(line, sizeof line, "loop %.0f us late  %llu overruns of %llu  device %s%s",
                  1e-3 * static_cast<double>(loop.last.lateness_ns),
                  static_cast<unsigned long long>(loop.counters.overruns),
                  static_cast<unsigned long long>(loop.counters.ticks), to_string(loop.last.device),
                  loop.last.playing ? "" : "  not playing");
    next(kTextColor, line);
  }
  if (note.empty()) {
    next(state.limit == ForceLimit::kNone ? kTextColor : kFeltColor,
         ("h: help    " + felt_line(state)).c_str());
  } else {
    next(kFeltColor, note.c_str());
  }
  brush.list.PopClipRect();
}

}  // namespace spidar
