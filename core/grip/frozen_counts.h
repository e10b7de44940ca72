// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds strings whose encoder has stopped counting while the others go on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/grip/string_geometry.h"

namespace spidar {

/// For each string, remembers the lengths of all strings at the time when its own changed last.
class FrozenCounts {
 public:
  void update(const StringVector& lengths_m, int count) noexcept {
    still_ = 0;
    for (int i = 0; i < count; ++i) {
      StringVector& then = at_change_m_[static_cast<size_t>(i)];
      if (then[i] != lengths_m[i]) {
        then = lengths_m;
      } else {
        still_ |= 1u << i;
      }
    }
  }

  /// Whether string `i` did not change with the last update.
  bool is_still(int i) const noexcept { return still_ >> i & 1; }

  /// How far the other strings have moved since string `i` changed last, in metres: the second
  /// largest distance, because a single count may have jumped.
  double missed_m(const StringVector& lengths_m, int count, int i) const noexcept {
    const StringVector& then = at_change_m_[static_cast<size_t>(i)];
    double most = 0, second = 0;
    for (int k = 0; k < count; ++k) {
      const double moved = std::abs(lengths_m[k] - then[k]);
      second = std::max(second, std::min(most, moved));
      most = std::max(most, moved);
    }
    return second;
  }

 private:
  static StringVector never() noexcept { return StringVector::Constant(-1); }  // no length

  unsigned still_ = 0;
  std::array<StringVector, kMaxStrings> at_change_m_{never(), never(), never(), never(),
                                                     never(), never(), never(), never()};
};

}  // namespace spidar
