// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be felt of a track at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/api.h"
#include "core/force/wrench_timeline.h"
#include "core/track/track_block.h"

namespace spidar {

/// Goes through blocks in the order of their times and interpolates linearly between samples, never
/// extrapolates. No allocation. The blocks stay with their owner until they are over:
///
///     while (block = oldest block) if (!reader.read(*block, now)) break; else drop the oldest
///     result = reader.at(now, block)
class SPIDAR_API TrackReader {
 public:
  /// How long the last sample holds when the next one is late: with SafetyLimits::ramp_s the force
  /// is gone 45 ms after the last sample of a track of 1 kHz.
  static constexpr int64_t kHold_ns = 5'000'000;

  /// Reads the samples of `block` that are due. True when there is nothing more in it.
  bool read(const TrackBlock& block, int64_t time_ns) noexcept;

  /// Between what was read and the next sample, which is in `next`, the block that read() has not
  /// come to the end of; null when there is none.
  TimelineResult at(int64_t time_ns, const TrackBlock* next) const noexcept;

  void clear() noexcept { *this = {}; }

 private:
  TrackSample last_{};
  int64_t last_ns_ = INT64_MIN;  // nothing was read yet
  int64_t period_ns_ = 0;        // of the block that it was in
  size_t read_ = 0;              // samples of the oldest block
};

}  // namespace spidar
