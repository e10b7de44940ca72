// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A block of samples of a track, on its way to the haptic loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/track/track_format.h"

namespace spidar {

/// Up to 40 samples that follow each other at equal distances of running time.
struct TrackBlock {
  static constexpr size_t kCapacity = 40;

  int64_t begin_ns = 0;     ///< running time of the first sample
  int64_t duration_ns = 0;  ///< of all of them; > 0
  size_t count = 0;         ///< 1 … kCapacity
  std::array<TrackSample, kCapacity> samples{};

  /// Running time of sample `i`; for `count`, that of the first sample of the next block.
  int64_t time_ns(size_t i) const noexcept {
    return begin_ns + duration_ns * static_cast<int64_t>(i) / static_cast<int64_t>(count);
  }
  int64_t period_ns() const noexcept { return duration_ns / static_cast<int64_t>(count); }
};

}  // namespace spidar
