// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Counts of a board whose counters wrap round. They continue when the board is reopened.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/grip/string_geometry.h"

namespace spidar::boards {

/// Unwraps up to kMaxStrings counters of `bits` bits, assuming that each takes the shorter way.
class CountUnwrapper {
 public:
  /// No hand moves a string further between two readings. A quarter of 16 bits is 0.28 m at 17 µm
  /// per count; a hand at 10 m/s needs 28 ms for that, and a board counts as lost after 20 ms.
  static constexpr int32_t kMaxStep = 1 << 14;

  /// 16 … 31 bits.
  explicit CountUnwrapper(int bits) noexcept : bits_(bits) {}

  /// Converts the board's counter values to counts that continue from the last ones, or from the
  /// ones before if a flipped bit has spoilt the last ones. Returns false and changes nothing when
  /// a counter has moved further than `max_step` from both.
  bool update(const std::array<uint32_t, kMaxStrings>& raw, size_t channels,
              int32_t max_step = kMaxStep) noexcept {
    if (distance(raw, last_.raw, channels) > max_step) {
      if (distance(raw, before_.raw, channels) > max_step) return false;
      last_ = before_;
    } else {
      before_ = last_;
    }
    for (size_t i = 0; i < channels; ++i) {
      const auto step = static_cast<uint32_t>(signed_difference(raw[i] - last_.raw[i]));
      last_.count[i] = static_cast<int32_t>(static_cast<uint32_t>(last_.count[i]) + step);
    }
    last_.raw = raw;
    return true;
  }

  /// Continues with the counters after a break in which the board was not read. Returns false and
  /// changes nothing when a counter has jumped, or when a loss of power seems to have reset the
  /// counters: they are nearer to zero than to their previous values, which were not near zero. The
  /// counters look the same after a hand has moved the grip towards their zero. To mistake such a
  /// motion for a reset costs a new zero; the opposite mistake would keep a wrong zero. begin()
  /// accepts any counters.
  bool resume(const std::array<uint32_t, kMaxStrings>& raw, size_t channels) noexcept {
    const int32_t moved = distance(raw, last_.raw, channels);
    const bool anew = moved > kStill && distance(last_.raw, {}, channels) > kStill &&
                      distance(raw, {}, channels) <= moved;
    return !anew && update(raw, channels);
  }

  /// Starts with the counter values of a first reading, sign-extended, as counts.
  void begin(const std::array<uint32_t, kMaxStrings>& raw, size_t channels) noexcept {
    last_ = {raw, {}};
    for (size_t i = 0; i < channels; ++i) last_.count[i] = signed_difference(raw[i]);
    before_ = last_;
  }

  void zero() noexcept {
    last_.count = {};
    before_ = last_;
  }

  const std::array<int32_t, kMaxStrings>& counts() const noexcept { return last_.count; }

 private:
  struct Values {
    std::array<uint32_t, kMaxStrings> raw{};
    std::array<int32_t, kMaxStrings> count{};
  };

  /// 1 mm: a zero that is off by less does no harm, and a grip that nobody moves stays within 1 mm.
  static constexpr int32_t kStill = 64;

  /// Returns the largest difference of a counter.
  int32_t distance(const std::array<uint32_t, kMaxStrings>& from,
                   const std::array<uint32_t, kMaxStrings>& to, size_t channels) const noexcept {
    int32_t most = 0;
    for (size_t i = 0; i < channels; ++i) {
      const int32_t difference = signed_difference(from[i] - to[i]);
      // The most negative integer cannot be negated.
      most = std::max({most, difference, -std::max(difference, -INT32_MAX)});
    }
    return most;
  }

  int32_t signed_difference(uint32_t difference) const noexcept {
    const uint32_t sign = uint32_t{1} << (bits_ - 1);
    const uint32_t low = difference & ((sign << 1) - 1);
    return static_cast<int32_t>(low ^ sign) - static_cast<int32_t>(sign);
  }

  int bits_;
  Values last_;
  Values before_;  ///< values of the reading before the last one
};

class EncoderCounts {
 public:
  /// 35 m/s at 17 µm per count, 16 m/s at the finest resolution of the profiles.
  static constexpr int32_t kMaxStepPer_ms = 2048;
  static_assert(8 * kMaxStepPer_ms <= CountUnwrapper::kMaxStep);

  explicit EncoderCounts(int bits) noexcept : unwrapper_(bits) {}

  void open(const std::array<uint32_t, kMaxStrings>& raw, size_t channels) noexcept {
    first_ = raw;
    channels_ = channels;
    if (!counted_) unwrapper_.begin(raw, channels);
    counted_ = true;
    restarted_ |= !unwrapper_.resume(raw, channels);
  }

  /// Whether the counters were reset since the board was first open. Then their values are
  /// meaningless until zero(), even those that look right later because a hand has moved the grip.
  bool restarted() const noexcept { return restarted_; }

  /// Sets zero to the position of the first reading.
  void zero() noexcept {
    unwrapper_.begin(first_, channels_);
    unwrapper_.zero();
    restarted_ = false;
  }

  /// Adds a reading at `now_ns` (CLOCK_MONOTONIC). Returns false and ignores the reading if a
  /// counter has changed by more than a hand can cause in the time since the last reading, whether
  /// that was good or not: the counters of a board that loses its power for a moment jump and do
  /// not return.
  bool update(const std::array<uint32_t, kMaxStrings>& raw, int64_t now_ns) noexcept {
    const int64_t passed_ms = std::clamp<int64_t>((now_ns - last_ns_) / 1'000'000, 0, 7);
    last_ns_ = now_ns;
    return unwrapper_.update(raw, channels_, kMaxStepPer_ms * static_cast<int32_t>(1 + passed_ms));
  }

  const std::array<int32_t, kMaxStrings>& counts() const noexcept { return unwrapper_.counts(); }

 private:
  CountUnwrapper unwrapper_;
  std::array<uint32_t, kMaxStrings> first_{};
  size_t channels_ = 0;
  int64_t last_ns_ = 0;
  bool counted_ = false;
  bool restarted_ = false;
};

}  // namespace spidar::boards
