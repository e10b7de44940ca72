// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reduces the number of samples a second.
#pragma once

#include <cstddef>

#include "core/track/track_format.h"

namespace spidar {

/// Replaces groups of successive samples by their mean, so that frequencies that the haptic loop
/// cannot render do not appear as others.
class TrackThinner {
 public:
  /// For tracks of this rate: the size of a group brings it to kTrackRate_Hz or below.
  void begin(int rate_Hz) noexcept {
    *this = {};
    group_ = static_cast<size_t>((rate_Hz + kTrackRate_Hz - 1) / kTrackRate_Hz);
  }
  /// The next sample does not continue the previous ones.
  void restart() noexcept { filled_ = 0; }

  size_t group() const noexcept { return group_; }

  /// Returns true when `sample` completes a group, and replaces it by the mean.
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
