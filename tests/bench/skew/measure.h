// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the times of picture and force in one playback.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/skew/player.h"

namespace spidar::bench {

struct Measurement {
  /// Force − picture of each frame that was both shown and felt, ms.
  std::vector<double> skew_ms;
  uint64_t shown = 0;
  uint64_t dropped = 0;  ///< frames that came to the sink too late
  double clock_ppm = 0;  ///< drift of the pipeline's clock against CLOCK_MONOTONIC
  std::string scheduling;
};

/// Plays for `seconds` and joins every frame shown with the first tick of the haptic loop that had
/// reached it. Throws std::runtime_error when the playback fails.
Measurement measure(const Scenario& scenario, const std::string& clip, double seconds);

}  // namespace spidar::bench
