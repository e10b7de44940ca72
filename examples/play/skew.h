// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Time between a picture and its force.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "examples/play/histogram.h"

/// Joins, by the running time of the frame, when it was shown with when its force was at the
/// device. The two become known in either order and some frames never get one of them: of each kind
/// only the newest kMaxWaiting wait.
class Skew {
 public:
  void shown(int64_t frame_ns, int64_t monotonic_ns);

  /// Call for every tick; the first one with a frame counts.
  void felt(int64_t frame_ns, int64_t monotonic_ns);

  const Histogram& signed_ms() const { return signed_ms_; }  ///< > 0: force after picture
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
