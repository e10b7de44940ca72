// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Counts of a board that continue when it is closed and opened again.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "spidar/protocols/count_unwrapper.h"

namespace spidar {

class EncoderCounts {
 public:
  using Raw = std::array<uint32_t, kMaxStrings>;

  /// 35 m/s at 17 µm per count, 16 m/s at the finest resolution of the profiles.
  static constexpr int32_t kMaxStepPer_ms = 2048;
  static_assert(8 * kMaxStepPer_ms <= CountUnwrapper::kMaxStep);

  explicit EncoderCounts(int bits) noexcept : unwrapper_(bits) {}

  /// First reading after opening.
  void open(const Raw& raw, size_t channels) noexcept {
    first_ = raw;
    channels_ = channels;
    if (!counted_) unwrapper_.begin(raw, channels);
    counted_ = true;
    restarted_ = !unwrapper_.resume(raw, channels);
  }

  /// The counters were reset since the board was last open: their values are meaningless until
  /// zero().
  bool restarted() const noexcept { return restarted_; }

  /// Sets zero to the position of the first reading.
  void zero() noexcept {
    unwrapper_.begin(first_, channels_);
    unwrapper_.zero();
    restarted_ = false;
  }

  /// Takes a reading at `now_ns` (CLOCK_MONOTONIC). Returns false and ignores it if a counter
  /// changed by more than a hand can cause since the last reading, whether that one was good or
  /// not: the counters of a board that loses its power for a moment jump, and do not jump back.
  bool follow(const Raw& raw, int64_t now_ns) noexcept {
    const int64_t passed_ms = std::clamp<int64_t>((now_ns - last_ns_) / 1'000'000, 0, 7);
    last_ns_ = now_ns;
    return unwrapper_.follow(raw, channels_, kMaxStepPer_ms * static_cast<int32_t>(1 + passed_ms));
  }

  const std::array<int32_t, kMaxStrings>& counts() const noexcept { return unwrapper_.counts(); }

 private:
  CountUnwrapper unwrapper_;
  Raw first_{};
  size_t channels_ = 0;
  int64_t last_ns_ = 0;
  bool counted_ = false;
  bool restarted_ = false;
};

}  // namespace spidar
