// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/timeline.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace spidar::window {
namespace {

double time_s(const ForceTick& tick) {
  return 1e-9 * static_cast<double>(tick.monotonic_ns);
}

void include(ForceColumn& column, const ForceTick& tick) {
  if (std::exchange(column.is_empty, false)) {
    column.wanted_low_N = column.wanted_high_N = tick.wanted_N;
    column.delivered_low_N = column.delivered_high_N = tick.delivered_N;
  }
  column.wanted_low_N = column.wanted_low_N.cwiseMin(tick.wanted_N);
  column.wanted_high_N = column.wanted_high_N.cwiseMax(tick.wanted_N);
  column.delivered_low_N = column.delivered_low_N.cwiseMin(tick.delivered_N);
  column.delivered_high_N = column.delivered_high_N.cwiseMax(tick.delivered_N);
  column.most_N = std::max(column.most_N, tick.delivered_N.norm());
}

}  // namespace

void Timeline::add(const Moment& moment) {
  moments_.push_back(moment);
  largest_speed_px_s_ = std::max(largest_speed_px_s_, moment.speed_px_s);
  while (moments_.front().time_s < moment.time_s - kMemory_s) moments_.pop_front();
}

void Timeline::add(const ForceTick& tick) {
  if (!ticks_.empty() && tick.monotonic_ns <= ticks_.back().monotonic_ns) return;
  ticks_.push_back(tick);
  while (time_s(ticks_.front()) < time_s(tick) - kMemory_s) ticks_.pop_front();
}

std::vector<ForceColumn> Timeline::columns(double from_s, double to_s, size_t count) const {
  /// Nothing is known between two ticks that are further apart.
  constexpr double kGap_s = 0.5;
  std::vector<ForceColumn> columns(count);
  const auto is_before = [](const ForceTick& tick, double at_s) { return time_s(tick) < at_s; };
  auto tick = std::lower_bound(ticks_.begin(), ticks_.end(), from_s, is_before);
  size_t before = 0;
  for (const ForceTick* last = nullptr; tick != ticks_.end() && time_s(*tick) <= to_s; ++tick) {
    const double fraction = (time_s(*tick) - from_s) / (to_s - from_s);
    const size_t at =
        std::min(static_cast<size_t>(fraction * static_cast<double>(count)), count - 1);
    // Include the previous tick, so that the curve has no gap.
    for (size_t i = before; last && i <= at; ++i) {
      if (time_s(*tick) - time_s(*last) <= kGap_s) include(columns[i], *last);
    }
    include(columns[at], *tick);
    before = at;
    last = &*tick;
  }
  return columns;
}

void Timeline::clear() {
  moments_.clear();
  ticks_.clear();
  largest_speed_px_s_ = 0;
}

void Timeline::zoom(double factor) {
  plotted_s_ = std::clamp(plotted_s_ * factor, kMinPlotted_s, kMaxPlotted_s);
}

double Timeline::remembered_s() const {
  const double oldest_s = moments_.empty() ? 0 : newest_s() - moments_.front().time_s;
  for (const double shown_s : {5.0, 10.0, 20.0, 30.0}) {
    if (std::max(oldest_s, plotted_s_) <= shown_s) return shown_s;
  }
  return kMemory_s;
}

std::vector<Moment> Timeline::plotted() const {
  const auto is_before = [](const Moment& moment, double time_s) { return moment.time_s < time_s; };
  return {std::lower_bound(moments_.begin(), moments_.end(), newest_s() - plotted_s_, is_before),
          moments_.end()};
}

std::vector<double> Timeline::gain_curve(const ControllerSettings& settings, double highest_px_s,
                                         int points) const {
  std::vector<double> curve;
  try {
    GainController controller(settings);
    controller.force_N(largest_speed_px_s_);
    for (const Moment& moment : plotted()) {
      if (moment.interval_s > 0) controller.force_N(moment.speed_px_s, moment.interval_s);
    }
    for (int i = 0; i < points; ++i) {
      curve.push_back(controller.force_N(highest_px_s * i / std::max(points - 1, 1)));
    }
  } catch (const std::invalid_argument&) {
    curve.clear();
  }
  return curve;
}

}  // namespace spidar::window
