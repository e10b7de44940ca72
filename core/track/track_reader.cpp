// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/track_reader.h"

#include <algorithm>

namespace spidar {
namespace {

/// If samples are further apart, some are missing between them. In slow motion, no sample is
/// rendered for longer than a frame.
int64_t longest_step_ns(int64_t period_ns) {
  return std::min(period_ns + period_ns / 2, WrenchTimeline::kLongestHold_ns);
}

}  // namespace

bool TrackReader::read(const TrackBlock& block, int64_t time_ns) noexcept {
  for (; read_ < block.count && block.time_ns(read_) <= time_ns; ++read_) {
    // A late sample counts only if it is newer than the last rendered one.
    if (block.time_ns(read_) <= last_ns_) continue;
    last_ = block.samples[read_];
    last_ns_ = block.time_ns(read_);
    period_ns_ = block.period_ns();
  }
  if (read_ < block.count) return false;
  read_ = 0;
  return true;
}

TimelineResult TrackReader::at(int64_t time_ns, const TrackBlock* next) const noexcept {
  TimelineResult result;
  if (last_ns_ == INT64_MIN) return result;
  result.frame_time_ns = last_ns_;
  result.wrench = to_wrench(last_);
  const int64_t since_ns = time_ns - last_ns_;
  if (since_ns <= 0) {
    // A clock may go back a little; if it goes back further, time starts again.
    if (since_ns < -kHold_ns) return {};
    result.found = since_ns == 0 ? Found::kExact : Found::kHeld;
    return result;
  }
  if (next) {
    const int64_t step_ns = next->time_ns(read_) - last_ns_;
    if (step_ns <= longest_step_ns(std::max(period_ns_, next->period_ns()))) {
      const double s = static_cast<double>(since_ns) / static_cast<double>(step_ns);
      result.wrench = interpolate(result.wrench, to_wrench(next->samples[read_]), s);
      result.found = Found::kInterpolated;
      return result;
    }
  }
  const int64_t held_ns = std::max(kHold_ns, longest_step_ns(period_ns_));
  result.found = since_ns <= held_ns ? Found::kHeld : Found::kExpired;
  return result;
}

}  // namespace spidar
