// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The period of the haptic loop, and which moment of the video is on the screen.
#pragma once

#include <cstdint>

namespace spidar {

constexpr int64_t kTick_ns = 1'000'000;  ///< 1 kHz
constexpr double kTick_s = 1e-9 * kTick_ns;

/// A line through one observation: running time presented = running_ns + (t − monotonic_ns) · rate,
/// t on CLOCK_MONOTONIC. The streaming thread refreshes it, the haptic thread reads it.
struct PlaybackClock {
  int64_t monotonic_ns = 0;
  int64_t running_ns = 0;
  double rate = 1.0;     ///< pipeline clock seconds per monotonic second, near 1
  bool playing = false;  ///< false: preroll, paused or no clock, so no force is wanted
  /// CLOCK_MONOTONIC until which the line is valid unless it is refreshed. A clock that stands
  /// still leaves a picture on the screen, and its force must not act indefinitely.
  int64_t valid_until_ns = INT64_MAX;

  /// Whether frames are shown at `t_ns` of CLOCK_MONOTONIC, as far as known.
  bool plays_at(int64_t t_ns) const noexcept { return playing && t_ns < valid_until_ns; }

  int64_t running_at(int64_t t_ns) const noexcept {
    return running_ns + static_cast<int64_t>(static_cast<double>(t_ns - monotonic_ns) * rate);
  }
};

}  // namespace spidar
