// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/track/track_format.h"

namespace spidar {

/// Samples the curve that the haptic loop renders between frames (WrenchTimeline), every
/// millisecond of the frames' own time scale. Where no frame follows, the loop leaves a ramp to the
/// safety chain; here the ramp is part of the samples, so that a track does not step to zero.
class TrackSampler {
 public:
  /// The first sample is at the first whole millisecond from `from_ns` >= 0 on. Forgets all frames.
  void begin(int64_t from_ns) noexcept {
    *this = {};
    next_ns_ = (from_ns + kTrackPeriod_ns - 1) / kTrackPeriod_ns * kTrackPeriod_ns;
  }

  /// Times must increase; otherwise returns false and adds nothing.
  bool add(const TimedWrench& frame) noexcept {
    if (frame.time_ns <= latest_ns_ || !timeline_.push(frame)) return false;
    latest_ns_ = frame.time_ns;
    if (!frame.repeated) {
      before_newest_ns_ = newest_ns_;
      newest_ns_ = frame.motion_ns();
    }
    return true;
  }

  /// The time until which future frames do not change the curve, unless they are further than
  /// `look_ahead_ns` from the last added one: the time of the motion of the last but one frame that
  /// does not repeat a picture.
  int64_t settled_ns(int64_t look_ahead_ns) const noexcept {
    return std::max(before_newest_ns_, latest_ns_ - look_ahead_ns);
  }

  int64_t next_ns() const noexcept { return next_ns_; }
  /// Returns the next sample; the following one is a millisecond later.
  Wrench next() noexcept {
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

 private:
  WrenchTimeline timeline_;
  int64_t next_ns_ = 0;
  int64_t latest_ns_ = INT64_MIN / 2;  ///< time of the latest frame
  int64_t newest_ns_ = INT64_MIN / 2;  ///< motion time of the newest frame with a new picture
  int64_t before_newest_ns_ = INT64_MIN / 2;
  int64_t expired_ns_ = 0;  ///< how long the wrench has been ramping to zero
};

}  // namespace spidar
