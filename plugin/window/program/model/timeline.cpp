// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/timeline.h"

#include <algorithm>
#include <utility>

namespace spidar {
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
  std::deque<Moment>& moments = live_.moments;
  moments.push_back(moment);
  largest_speed_px_s_ = std::max(largest_speed_px_s_, moment.speed_px_s);
  const double oldest_s = moment.time_s - kMemory_s;
  while (moments.front().time_s < oldest_s) moments.pop_front();
  while (!live_.stills.empty() && live_.stills.front()->time_s < oldest_s) {
    live_.stills.pop_front();
  }
}

void Timeline::add(const ForceTick& tick) {
  std::deque<ForceTick>& ticks = live_.ticks;
  if (!ticks.empty() && tick.monotonic_ns <= ticks.back().monotonic_ns) return;
  ticks.push_back(tick);
  while (time_s(ticks.front()) < time_s(tick) - kMemory_s) ticks.pop_front();
}

std::vector<ForceColumn> Timeline::columns(double from_s, double to_s, size_t count) const {
  /// Between two ticks that are further apart nothing is known.
  constexpr double kGap_s = 0.5;
  std::vector<ForceColumn> columns(count);
  const std::deque<ForceTick>& ticks = shown().ticks;
  const auto is_before = [](const ForceTick& tick, double at_s) { return time_s(tick) < at_s; };
  auto tick = std::lower_bound(ticks.begin(), ticks.end(), from_s, is_before);
  size_t before = 0;
  for (const ForceTick* last = nullptr; tick != ticks.end() && time_s(*tick) <= to_s; ++tick) {
    const double share = (time_s(*tick) - from_s) / (to_s - from_s);
    const size_t at = std::min(static_cast<size_t>(share * static_cast<double>(count)), count - 1);
    // From the tick before on, so that what is drawn has no gaps.
    for (size_t i = before; last && i <= at; ++i)
      if (time_s(*tick) - time_s(*last) <= kGap_s) include(columns[i], *last);
    include(columns[at], *tick);
    before = at;
    last = &*tick;
  }
  return columns;
}

bool Timeline::wants_still(double time_s) const {
  return live_.stills.empty() || time_s >= live_.stills.back()->time_s + kStill_s;
}

void Timeline::add_still(std::shared_ptr<const Still> still) {
  live_.stills.push_back(std::move(still));
}

void Timeline::forget() {
  live_ = {};
  largest_speed_px_s_ = 0;
}

void Timeline::pause() {
  if (frozen_ || live_.moments.empty()) return;
  frozen_ = Frozen{live_, live_.moments.back().time_s};
}

void Timeline::look_at(double time_s) {
  pause();
  if (!frozen_) return;
  const std::deque<Moment>& moments = frozen_->record.moments;
  frozen_->cursor_s = std::clamp(time_s, moments.front().time_s, moments.back().time_s);
}

void Timeline::zoom(double factor) {
  plotted_s_ = std::clamp(plotted_s_ * factor, kLeastPlotted_s, kMostPlotted_s);
}

double Timeline::cursor_s() const {
  if (frozen_) return frozen_->cursor_s;
  return live_.moments.empty() ? 0 : live_.moments.back().time_s;
}

Timeline::Part Timeline::plotted() const {
  const std::deque<Moment>& moments = shown().moments;
  const double cursor = cursor_s();
  const auto is_before = [](const Moment& moment, double time_s) { return moment.time_s < time_s; };
  const auto is_after = [](double time_s, const Moment& moment) { return time_s < moment.time_s; };
  return {std::lower_bound(moments.begin(), moments.end(), cursor - plotted_s_, is_before),
          std::upper_bound(moments.begin(), moments.end(), cursor, is_after)};
}

std::shared_ptr<const Still> Timeline::still() const {
  if (!frozen_) return nullptr;
  const auto& stills = frozen_->record.stills;
  const auto after =
      std::upper_bound(stills.begin(), stills.end(), frozen_->cursor_s,
                       [](double time_s, const auto& still) { return time_s < still->time_s; });
  if (stills.empty()) return nullptr;
  return after == stills.begin() ? *after : *(after - 1);
}

}  // namespace spidar
