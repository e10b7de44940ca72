// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/track_sampler.h"

#include "core/track/track_format.h"

namespace spidar {

void TrackSampler::begin(int64_t from_ns) noexcept {
  *this = {};
  next_ns_ = (from_ns + kTrackPeriod_ns - 1) / kTrackPeriod_ns * kTrackPeriod_ns;
}

bool TrackSampler::add(const TimedWrench& frame) noexcept {
  if (frame.time_ns <= latest_ns_ || !timeline_.push(frame)) return false;
  latest_ns_ = frame.time_ns;
  if (!frame.repeated) {
    before_newest_ns_ = newest_ns_;
    newest_ns_ = frame.time_ns;
  }
  return true;
}

Wrench TrackSampler::take() noexcept {
  const TimelineResult result = timeline_.at(next_ns_);
  next_ns_ += kTrackPeriod_ns;
  if (result.found != Found::kExpired) {
    expired_ns_ = 0;
    return result.wrench;
  }
  expired_ns_ = std::min(expired_ns_ + kTrackPeriod_ns, WrenchTimeline::kRamp_ns);
  const double left = 1 - static_cast<double>(expired_ns_) / WrenchTimeline::kRamp_ns;
  return left * left * (3 - 2 * left) * result.wrench;
}

}  // namespace spidar
