// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks in exchange formats: MPEG's HJIF (ISO/IEC 23090-31) and AHAP of Core Haptics.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// A track of 1000 samples a second that need not be in memory.
struct SampleSource {
  using Take = std::function<void(const TrackSample&)>;
  size_t count = 0;
  /// Each call passes all samples in order to its argument.
  std::function<void(const Take&)> each;
};
/// Receives the next piece of the written file.
using WriteText = std::function<void(const std::string&)>;

/// An error in a file. The message says what is wrong, and where.
class TrackFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The usual tolerance of write_hjif(), as a fraction of the full scale.
constexpr double kHjifTolerance = 4e-4;

/// Writes HJIF of a track of 1000 samples a second: one perception of modality Force with six
/// channels, fx fy fz tx ty tz, 1.0 of which is the full scale. HJIF has no modality for torque, so
/// the descriptions of the channels name it. Each channel is one curve of straight lines whose
/// keyframes are samples. The curve differs from the other samples by at most `tolerance` of the
/// full scale, and from the keyframes by half of 1e-5. Amplitudes beyond the full scale are
/// clipped, as the format requires; NaN becomes 0.
void write_hjif(const SampleSource& samples, const WriteText& write,
                double tolerance = kHjifTolerance);

/// The longest track that read_hjif() accepts: 12 h.
constexpr size_t kMaxHjifSamples = size_t{12} * 3600 * kTrackRate_Hz;

/// Returns the samples, 1000 a second, of the first perception of modality Force, which must have
/// six channels. Curves of straight lines are evaluated and summed, multiplied by the gain of their
/// channel; an effect is silent before its first and after its last keyframe. Throws TrackFileError
/// for a text that is not JSON, a value that is missing or out of range, other bands or curves, and
/// more than `most_samples`. `others` gets the perceptions that are not read: "perceptions[0]
/// (Vibrotactile)".
std::vector<TrackSample> read_hjif(const std::string& text, size_t most_samples = kMaxHjifSamples,
                                   std::vector<std::string>* others = nullptr);

/// Limits of the gain for formats with a range of their own: a peak between a thousand times and a
/// millionth of the full scale fills that range.
constexpr double kMinGain = 1e-3, kMaxGain = 1e6;

/// The usual tolerance of write_ahap(), as a fraction of the full scale.
constexpr double kAhapTolerance = 0.02;

/// Writes a vibration as strong as the force: a continuous event whose intensity is the magnitude
/// of the force as a fraction of the full scale. The intensity follows straight lines, which differ
/// from that magnitude by at most `tolerance`, and half of 1e-3. A telephone has neither directions
/// nor torque, so both are lost. Magnitudes beyond the full scale are clipped, and NaN becomes 0.
/// The description states the force of an intensity of 1, if the samples have been multiplied by
/// `gain`.
///
/// Source: Apple, "Representing haptic patterns in AHAP files", and CHHapticEvent.duration: an
/// event lasts 30 s at most. Users report that only the first 16 points of a curve are used.
void write_ahap(const SampleSource& samples, const WriteText& write,
                double tolerance = kAhapTolerance, double gain = 1);

}  // namespace spidar
