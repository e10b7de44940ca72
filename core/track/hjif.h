// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks in MPEG's format for haptics, ISO/IEC 23090-31.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// Says what was wrong with a file, and where.
class HjifError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// HJIF of a track of 1000 samples a second: one perception of modality Force with six channels, fx
/// fy fz tx ty tz, 1.0 of which is the full scale. HJIF has no modality for torque, so the
/// descriptions of the channels name it. Each channel is one curve of straight lines whose
/// keyframes are samples. The curve differs from the other samples by at most `tolerance` of the
/// full scale, and from the keyframes by half of 1e-5. Amplitudes beyond the full scale are
/// clipped, as the format requires; NaN becomes 0.
std::string write_hjif(const std::vector<TrackSample>& samples, double tolerance = 4e-4);

/// The longest track that read_hjif() takes: 12 h.
constexpr size_t kMostHjifSamples = size_t{12} * 3600 * kTrackRate_Hz;

/// Samples, 1000 a second, of the first perception of modality Force, which must have six channels.
/// Curves of straight lines are evaluated and summed, multiplied by the gain of their channel; an
/// effect is silent before its first and after its last keyframe. Throws HjifError: not JSON, a
/// value that is missing or out of range, other bands or curves, or more than `most_samples`.
std::vector<TrackSample> read_hjif(const std::string& text, size_t most_samples = kMostHjifSamples);

}  // namespace spidar
