// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the wrench of a track at a given time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/track/track_format.h"

namespace spidar {

/// Goes through blocks in the order of their times and interpolates linearly between samples; never
/// extrapolates. Does not allocate. The blocks stay with their owner until they have been read:
///
///     while (block = oldest block) if (!reader.read(*block, now)) break; else drop the oldest
///     result = reader.at(now, block)
class TrackReader {
 public:
  /// How long the last sample holds when the next one is late. With SafetyLimits::ramp_s the force
  /// is zero 45 ms after the last sample of a track of 1 kHz.
  static constexpr int64_t kHold_ns = 5'000'000;

  /// Reads the samples of `block` that are due. Returns true when the block has been read
  /// completely.
  bool read(const TrackBlock& block, int64_t time_ns) noexcept;

  /// The wrench between the last sample that was read and the next one, which is in `next`: the
  /// block that read() has not finished, or null when there is none.
  TimelineResult at(int64_t time_ns, const TrackBlock* next) const noexcept;

  void clear() noexcept { *this = {}; }

 private:
  TrackSample last_{};
  int64_t last_ns_ = INT64_MIN;  // nothing was read yet
  int64_t period_ns_ = 0;        // of the block to which that belongs
  size_t read_ = 0;              // samples of the oldest block
};

}  // namespace spidar
