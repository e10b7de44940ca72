// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From the wrenches of frames to the samples of a track.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/api.h"
#include "core/force/wrench_timeline.h"

namespace spidar {

/// Samples the curve that the haptic loop feels between frames (WrenchTimeline), every millisecond
/// of the frames' own time scale. Where the loop would leave a ramp to the safety chain, because no
/// frame follows, the ramp is part of the samples: a track does not step to rest.
class SPIDAR_API TrackSampler {
 public:
  /// The first sample is the first whole millisecond at or after `from_ns` >= 0. Forgets all
  /// frames.
  void begin(int64_t from_ns) noexcept;

  /// Times must rise; false, and nothing is added, when they do not.
  bool add(const TimedWrench& frame) noexcept;

  /// Up to this time frames to come do not change the curve, unless they are further away than
  /// `look_ahead_ns` from the frame added last: the time of the last frame but one that shows a
  /// picture of its own.
  int64_t settled_ns(int64_t look_ahead_ns) const noexcept {
    return std::max(before_newest_ns_, latest_ns_ - look_ahead_ns);
  }

  /// Time of the next sample.
  int64_t next_ns() const noexcept { return next_ns_; }
  /// The next sample; the one after it is a millisecond later.
  Wrench take() noexcept;

 private:
  WrenchTimeline timeline_;
  int64_t next_ns_ = 0;
  int64_t latest_ns_ = INT64_MIN / 2;  // of all frames added
  int64_t newest_ns_ = INT64_MIN / 2;  // of those that show a picture of their own
  int64_t before_newest_ns_ = INT64_MIN / 2;
  int64_t expired_ns_ = 0;  // for how long the wrench has been going to rest
};

}  // namespace spidar
