// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Delays commanded tensions before they reach the motors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/grip/string_geometry.h"

namespace spidar {

/// A pure delay, as caused by a board, its amplifiers and its packets. Fixed size, no allocation.
class DelayedTensions {
 public:
  /// At one command per millisecond, a delay of 50 ms holds 50 commands.
  static constexpr size_t kCapacity = 64;

  /// Adds a command at `time_ns`, which must not decrease, that takes effect at `time_ns` +
  /// `delay_ns`. When the queue is full, the oldest command takes effect early.
  void put(int64_t time_ns, int64_t delay_ns, const StringVector& tension_N) noexcept {
    if (count_ == kCapacity) drop();
    waiting_[(first_ + count_++) % kCapacity] = {time_ns + delay_ns, tension_N};
  }

  /// The tensions in effect at `now_ns`.
  const StringVector& at(int64_t now_ns) noexcept {
    while (count_ > 0 && waiting_[first_].from_ns <= now_ns) drop();
    return acting_N_;
  }

  /// Time of the next change after at(); INT64_MAX when no command is pending.
  int64_t next_ns() const noexcept { return count_ > 0 ? waiting_[first_].from_ns : INT64_MAX; }

  /// Discards all commands and sets the tensions to zero.
  void clear() noexcept { *this = {}; }

 private:
  struct Waiting {
    int64_t from_ns = 0;
    StringVector tension_N = StringVector::Zero();
  };

  void drop() noexcept {
    acting_N_ = waiting_[first_].tension_N;
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }

  std::array<Waiting, kCapacity> waiting_{};
  size_t first_ = 0;
  size_t count_ = 0;
  StringVector acting_N_ = StringVector::Zero();
};

}  // namespace spidar
