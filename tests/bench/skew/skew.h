// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the time between a picture and its force.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "tests/bench/skew/histogram.h"

/// Pairs the time at which a frame was shown with the time at which its force reached the device,
/// by the frame's running time. The two become known in either order, and some frames never get one
/// of them: of each kind only the newest kMaxWaiting are kept.
class Skew {
 public:
  void shown(int64_t frame_ns, int64_t monotonic_ns);

  /// Call this for every tick; the first tick of a frame counts.
  void felt(int64_t frame_ns, int64_t monotonic_ns);

  /// > 0: the force came after the picture.
  const Histogram& signed_ms() const { return signed_ms_; }
  const Histogram& size_ms() const { return size_ms_; }

 private:
  static constexpr size_t kMaxWaiting = 4096;
  using Times = std::map<int64_t, int64_t>;  ///< CLOCK_MONOTONIC by running time

  void join(int64_t force_ns, int64_t picture_ns);
  static void keep(Times& times, int64_t frame_ns, int64_t monotonic_ns);

  Times shown_;
  Times felt_;
  int64_t last_felt_ns_ = INT64_MIN;
  Histogram signed_ms_;
  Histogram size_ms_;
};
