// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/track/track_format.h"

namespace spidar {

/// Replaces groups of successive samples by their mean, so that frequencies that the haptic loop
/// cannot render do not alias.
class TrackThinner {
 public:
  /// Begins a track of this rate: groups are so large that their rate is kTrackRate_Hz or below.
  void begin(int rate_Hz) noexcept {
    *this = {};
    group_ = static_cast<size_t>((rate_Hz + kTrackRate_Hz - 1) / kTrackRate_Hz);
  }
  /// Tells that the next sample does not continue the previous ones.
  void reset() noexcept { filled_ = 0; }

  size_t group() const noexcept { return group_; }

  /// Returns true when `sample` completes a group, and replaces it by the mean.
  bool add(TrackSample& sample) noexcept {
    if (group_ == 1) return true;
    for (size_t i = 0; i < kTrackChannels; ++i) {
      sum_[i] = (filled_ == 0 ? 0 : sum_[i]) + static_cast<double>(sample[i]);
    }
    if (++filled_ < group_) return false;
    filled_ = 0;
    for (size_t i = 0; i < kTrackChannels; ++i) {
      sample[i] = static_cast<float>(sum_[i] / static_cast<double>(group_));
    }
    return true;
  }

 private:
  size_t group_ = 1;
  size_t filled_ = 0;
  std::array<double, kTrackChannels> sum_{};  ///< finite if the floats are finite
};

/// Reads blocks in order of time and interpolates linearly between samples; never extrapolates.
/// Does not allocate. The blocks stay with their owner until they have been read:
///
///     while (block = oldest block) if (!reader.read(*block, now)) break; else drop the oldest
///     result = reader.at(now, block)
class TrackReader {
 public:
  /// How long the last sample holds when the next one is late. With SafetyLimits::ramp_s the force
  /// is zero 45 ms after the last sample of a track of 1 kHz.
  static constexpr int64_t kHold_ns = 5'000'000;

  /// Reads the due samples of `block`. Returns true when the block has been read completely.
  bool read(const TrackBlock& block, int64_t time_ns) noexcept;

  /// The wrench between the last read sample and the next one, which is in `next`: the block that
  /// read() has not finished, or null when there is none.
  TimelineResult at(int64_t time_ns, const TrackBlock* next) const noexcept;

  void clear() noexcept { *this = {}; }

 private:
  TrackSample last_{};
  int64_t last_ns_ = INT64_MIN;  ///< nothing was read yet
  int64_t period_ns_ = 0;        ///< of the block of that sample
  size_t read_ = 0;              ///< the number of read samples of the oldest block
};

}  // namespace spidar
