// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Counters of few bits as counts that go on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/grip/string_geometry.h"

namespace spidar {

/// Follows up to kMaxStrings counters of `bits` bits by the shorter way round.
class CountUnwrapper {
 public:
  /// More than that between two readings is not a hand: a quarter of 16 bits is 0.28 m at 17 µm a
  /// count, for which a hand at 10 m/s needs 28 ms; a board is lost after 20.
  static constexpr int32_t kMaxStep = 1 << 14;

  /// 16 … 31 bits.
  explicit CountUnwrapper(int bits) noexcept : bits_(bits) {}

  /// Counter values as the board gives them become counts that continue the last ones. False, and
  /// nothing taken over, when one of them moved further than `max_step`.
  bool follow(const std::array<uint32_t, kMaxStrings>& raw, size_t channels,
              int32_t max_step = kMaxStep) noexcept {
    std::array<int32_t, kMaxStrings> next = count_;
    for (size_t i = 0; i < channels; ++i) {
      const int32_t step = signed_difference(raw[i] - raw_[i]);
      if (step > max_step || step < -max_step) return false;
      next[i] =
          static_cast<int32_t>(static_cast<uint32_t>(count_[i]) + static_cast<uint32_t>(step));
    }
    count_ = next;
    raw_ = raw;
    return true;
  }

  /// The same after a break in which the board was not read. False, and nothing taken over, when
  /// its counters seem to have begun anew, as they do when it loses its power: all of them are near
  /// zero now, and neither there before nor where they are now; or one of them jumped. A grip that
  /// was moved by a hand while it was near the counters' zero looks the same: to be wrong about
  /// that costs a new zero, to be wrong about the other thing costs the right one. Call begin()
  /// when that is what is wanted.
  bool resume(const std::array<uint32_t, kMaxStrings>& raw, size_t channels) noexcept {
    const bool anew = within(kNearZero, raw, {}, channels) && !within(kStill, raw_, {}, channels) &&
                      !within(kStill, raw, raw_, channels);
    return !anew && follow(raw, channels);
  }

  /// Takes the counter values for the counts, sign extended: at a first reading.
  void begin(const std::array<uint32_t, kMaxStrings>& raw, size_t channels) noexcept {
    raw_ = raw;
    count_ = {};
    for (size_t i = 0; i < channels; ++i) count_[i] = signed_difference(raw[i]);
  }

  /// Here is zero.
  void zero() noexcept { count_ = {}; }

  const std::array<int32_t, kMaxStrings>& counts() const noexcept { return count_; }

 private:
  /// 17 mm at 17 µm a count: what strings go slack by while a board without power is switched on.
  static constexpr int32_t kNearZero = 1024;

  /// 1 mm: a zero that is wrong by less does no harm, and a grip that nobody moves moves less.
  static constexpr int32_t kStill = 64;

  /// Whether no counter differs from that of `other` by more than `counts`.
  bool within(int32_t counts, const std::array<uint32_t, kMaxStrings>& raw,
              const std::array<uint32_t, kMaxStrings>& other, size_t channels) const noexcept {
    for (size_t i = 0; i < channels; ++i) {
      const int32_t difference = signed_difference(raw[i] - other[i]);
      if (difference > counts || difference < -counts) return false;
    }
    return true;
  }

  int32_t signed_difference(uint32_t difference) const noexcept {
    const uint32_t sign = uint32_t{1} << (bits_ - 1);
    const uint32_t low = difference & ((sign << 1) - 1);
    return static_cast<int32_t>(low ^ sign) - static_cast<int32_t>(sign);
  }

  int bits_;
  std::array<uint32_t, kMaxStrings> raw_{};
  std::array<int32_t, kMaxStrings> count_{};
};

}  // namespace spidar
