// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// String lengths from encoder counts, and back.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "spidar/profiles/profile.h"

namespace spidar {

/// Direction, resolution and zero of each encoder of a profile. No allocation, no exceptions.
class EncoderScale {
 public:
  using Counts = std::array<int32_t, kMaxStrings>;

  explicit EncoderScale(const Profile& profile) noexcept
      : count_(profile.geometry.count), zero_m_(profile.zero_count_length_m()) {
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
      metres_[i] = profile.drives[i].encoder_sign * profile.drives[i].metres_per_count;
    }
  }

  /// The lengths from the exits to the grip, m; zero for strings that the device does not have.
  StringVector lengths_m(const Counts& counts) const noexcept {
    StringVector lengths_m = StringVector::Zero();
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<size_t>(i);
      lengths_m[i] = zero_m_[i] + metres_[k] * counts[k];
    }
    return lengths_m;
  }

  /// Sets the nearest counts; leaves those of strings without an encoder scale as they are.
  void to_counts(const StringVector& lengths_m, Counts& counts) const noexcept {
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<size_t>(i);
      if (metres_[k] == 0) continue;
      counts[k] = static_cast<int32_t>(std::lround((lengths_m[i] - zero_m_[i]) / metres_[k]));
    }
  }

 private:
  int count_;
  StringVector zero_m_;
  std::array<double, kMaxStrings> metres_{};  ///< per count, with the sign of the encoder
};

}  // namespace spidar
