// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fewer samples a second.
#pragma once

#include <cstddef>

#include "core/track/track_format.h"

namespace spidar {

/// Puts the mean of so many samples that follow each other in their place, so that what the haptic
/// loop cannot follow is not felt as something else.
class TrackThinner {
 public:
  /// For tracks of this rate: as many samples become one as bring it to kTrackRate_Hz or below.
  void begin(int rate_Hz) noexcept {
    *this = {};
    group_ = static_cast<size_t>((rate_Hz + kTrackRate_Hz - 1) / kTrackRate_Hz);
  }
  /// The next sample has nothing to do with the ones before.
  void restart() noexcept { filled_ = 0; }

  size_t group() const noexcept { return group_; }

  /// True when `sample` completes a group, whose mean it then becomes.
  bool add(TrackSample& sample) noexcept {
    if (group_ == 1) return true;
    for (size_t i = 0; i < kTrackChannels; ++i) {
      sum_[i] = (filled_ == 0 ? 0 : sum_[i]) + sample[i];
    }
    if (++filled_ < group_) return false;
    filled_ = 0;
    for (size_t i = 0; i < kTrackChannels; ++i) sample[i] = sum_[i] / static_cast<float>(group_);
    return true;
  }

 private:
  size_t group_ = 1;
  size_t filled_ = 0;
  TrackSample sum_{};
};

}  // namespace spidar
