// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the times of picture and force in one playback.
#pragma once

#include <cstdint>
#include <string>

#include "tests/bench/skew/histogram.h"
#include "tests/bench/skew/scenario.h"
#include "tests/bench/skew/skew.h"

namespace spidar::bench {

struct Measurement {
  Skew skew;             ///< force − picture
  Skew force;            ///< force − when the picture was due, see ShownFrame
  Histogram picture_ms;  ///< picture − when it was due
  uint64_t shown = 0;    ///< frames
  uint64_t dropped = 0;  ///< frames that came to the sink too late
  double clock_ppm = 0;  ///< drift of the pipeline's clock against CLOCK_MONOTONIC
  std::string scheduling;

  uint64_t not_felt() const { return shown - skew.signed_ms().count(); }
};

/// Plays for `seconds` and joins every frame shown with the first tick of the haptic loop that had
/// reached it. Throws std::runtime_error when the playback fails.
Measurement measure(const Scenario& scenario, const std::string& clip, double seconds);

}  // namespace spidar::bench
