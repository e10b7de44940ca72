// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the times of picture and force in one playback.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/skew/scenario.h"

namespace spidar::bench {

struct Measurement {
  // Of each frame that was both shown and felt, ms.
  std::vector<double> skew_ms;   ///< force − picture
  std::vector<double> force_ms;  ///< force − when the picture was due, see ShownFrame
  // Of each frame shown.
  std::vector<double> picture_ms;  ///< picture − when it was due
  uint64_t dropped = 0;            ///< frames that came to the sink too late
  double clock_ppm = 0;            ///< drift of the pipeline's clock against CLOCK_MONOTONIC
  std::string scheduling;

  uint64_t not_felt() const { return picture_ms.size() - skew_ms.size(); }
};

/// Plays for `seconds` and joins every frame shown with the first tick of the haptic loop that had
/// reached it. Throws std::runtime_error when the playback fails.
Measurement measure(const Scenario& scenario, const std::string& clip, double seconds);

}  // namespace spidar::bench
