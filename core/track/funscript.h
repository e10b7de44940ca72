// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One channel of a haptic track as a funscript, the positions of a linear device over time.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// Says what was wrong with a file, and where.
class FunscriptError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As much as the rounding of a position differs from the curve: half a step of 2 %.
constexpr double kFunscriptTolerance = 0.01;

/// One channel: −1, 0 and 1 are the positions 0, 50 and 100, whole numbers. Players draw straight
/// lines between them, and move at the speed that these ask for; they differ from the curve by at
/// most `tolerance`, a share of the full scale, and the rounding of a position, 0.01. Amplitudes
/// beyond the full scale are clipped, and NaN becomes 0.
std::string write_funscript(const std::vector<TrackSample>& samples, size_t channel,
                            double tolerance = kFunscriptTolerance);

/// The longest funscript that is read: 12 h.
constexpr size_t kMostFunscriptSamples = size_t{12} * 3600 * kTrackRate_Hz;

/// Samples, 1000 a second, of straight lines between the positions, in `channel`; the others are 0.
/// Before the first position they are 0, too. "range" is the percentage of the full scale that is
/// used: launchcontrol, the player that the format comes from, scales the positions by it, and its
/// usual limits put them about the middle. As there, 0 and a script without it stand for all.
/// Throws FunscriptError: not JSON, no actions, a position or range that is not from 0 to 100, or a
/// time that does not rise or is too late.
std::vector<TrackSample> read_funscript(const std::string& text, size_t channel,
                                        size_t most_samples = kMostFunscriptSamples);

}  // namespace spidar
