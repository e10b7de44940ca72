// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/position_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spidar::follow {

int64_t PositionFilter::begin_of(int64_t now_ns, int64_t position_ns) const {
  return now_ns - std::llround(static_cast<double>(position_ns) / rate_);
}

int64_t PositionFilter::earliest_ns() const {
  const auto end = begin_ns_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kKept));
  return *std::min_element(begin_ns_.begin(), end);
}

void PositionFilter::keep(int64_t begin_ns) {
  begin_ns_[count_++ % kKept] = begin_ns;
}

void PositionFilter::reset(int64_t now_ns, int64_t position_ns, double rate) {
  count_ = 0;
  rate_ = rate;
  position_ns_ = position_ns;
  newest_ns_ = now_ns;
  jumped_ = is_target_ = false;
  keep(begin_of(now_ns, position_ns));
}

void PositionFilter::change_rate(int64_t now_ns, double rate) {
  // add() ignores this position if it is reported again, because that report would be late.
  const int64_t reported_ns = position_ns_;
  reset(now_ns, position_at(now_ns), rate);
  position_ns_ = reported_ns;
}

/// Players report the target of a jump before they have reached it.
void PositionFilter::reset_after_jump(int64_t now_ns, int64_t position_ns) {
  reset(now_ns, position_ns, rate_);
  is_target_ = true;
}

void PositionFilter::add(int64_t now_ns, int64_t position_ns) {
  if (!has_begun() || position_ns == position_ns_) return;
  backward_ = position_ns < position_ns_ ? backward_ + 1 : 0;
  position_ns_ = position_ns;
  newest_ns_ = now_ns;
  const int64_t late_ns = begin_of(now_ns, position_ns) - earliest_ns();
  const bool jumped = std::abs(late_ns) > kMaxLate_ns;
  // A single late report may come from a moment in which the player, or this process, was delayed.
  if (jumped && (jumped_ || late_ns < 0 || count_ == 1)) {
    return reset_after_jump(now_ns, position_ns);
  }
  jumped_ = jumped;
  if (jumped) return;
  if (std::exchange(is_target_, false)) count_ = 0;
  keep(begin_of(now_ns, position_ns));
}

void PositionFilter::add_jump(int64_t now_ns, int64_t position_ns) {
  if (!has_begun()) return;
  backward_ = 0;
  const int64_t late_ns = begin_of(now_ns, position_ns) - earliest_ns();
  if (std::abs(late_ns) > kMaxLate_ns) return reset_after_jump(now_ns, position_ns);
  is_target_ = true;  // the player may have stopped for a moment
}

int64_t PositionFilter::position_at(int64_t now_ns) const {
  return std::llround(static_cast<double>(now_ns - earliest_ns()) * rate_);
}

int64_t small_correction_ns(int64_t error_ns, int64_t passed_ns, bool is_settling) {
  const double most = is_settling ? 0.5 : 0.02;
  // The time is long enough to smooth the jitter of the filter.
  const double time_ns = is_settling ? 0.1e9 : 0.5e9;
  const auto passed = static_cast<double>(passed_ns);
  const double wanted = static_cast<double>(error_ns) * passed / time_ns;
  return std::llround(std::clamp(wanted, -most * passed, most * passed));
}

}  // namespace spidar::follow
