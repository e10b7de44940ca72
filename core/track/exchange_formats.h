// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks in the formats of others: MPEG's HJIF (ISO/IEC 23090-31), funscripts, which are
/// the positions of a linear device over time, and AHAP, the files of Core Haptics.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// A track of 1000 samples a second that need not be in memory.
struct SampleSource {
  using Take = std::function<void(const TrackSample&)>;
  size_t count = 0;
  /// Gives all samples in their order, each time that it is called.
  std::function<void(const Take&)> each;
};
/// Takes the next piece of a file that is written.
using WriteText = std::function<void(const std::string&)>;

/// Says what was wrong with a file, and where.
class HjifError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Of the full scale.
constexpr double kHjifTolerance = 4e-4;

/// HJIF of a track of 1000 samples a second: one perception of modality Force with six channels, fx
/// fy fz tx ty tz, 1.0 of which is the full scale. HJIF has no modality for torque, so the
/// descriptions of the channels name it. Each channel is one curve of straight lines whose
/// keyframes are samples. The curve differs from the other samples by at most `tolerance` of the
/// full scale, and from the keyframes by half of 1e-5. Amplitudes beyond the full scale are
/// clipped, as the format requires; NaN becomes 0.
void write_hjif(const SampleSource& samples, const WriteText& write,
                double tolerance = kHjifTolerance);

/// The longest track that read_hjif() takes: 12 h.
constexpr size_t kMostHjifSamples = size_t{12} * 3600 * kTrackRate_Hz;

/// Samples, 1000 a second, of the first perception of modality Force, which must have six channels.
/// Curves of straight lines are evaluated and summed, multiplied by the gain of their channel; an
/// effect is silent before its first and after its last keyframe. Throws HjifError: not JSON, a
/// value that is missing or out of range, other bands or curves, or more than `most_samples`.
std::vector<TrackSample> read_hjif(const std::string& text, size_t most_samples = kMostHjifSamples);

/// Says what was wrong with a file, and where.
class FunscriptError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As much as the rounding of a position differs from the curve: half a step of 2 %.
constexpr double kFunscriptTolerance = 0.01;

/// One channel: −1, 0 and 1 are the positions 0, 50 and 100, whole numbers. Players draw straight
/// lines between them, and move at the speed that these ask for; they differ from the curve by at
/// most `tolerance`, a fraction of the full scale, and the rounding of a position, 0.01. Amplitudes
/// beyond the full scale are clipped, and NaN becomes 0. The script says which channel it is of,
/// and by which `gain` its samples have been multiplied.
void write_funscript(const SampleSource& samples, size_t channel, const WriteText& write,
                     double tolerance = kFunscriptTolerance, double gain = 1);

/// By which samples are multiplied for formats with a range of their own: a force between a
/// thousand times the full scale and a micronewton fills it.
constexpr double kLeastGain = 1e-3, kMostGain = 1e6;

/// What write_funscript() has noted; nothing in scripts of others. Throws FunscriptError: not JSON,
/// or a gain from which no samples can be had back.
struct FunscriptNotes {
  size_t channel;
  double gain;
};
std::optional<FunscriptNotes> read_funscript_notes(const std::string& text);

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

/// Of the full scale.
constexpr double kAhapTolerance = 0.02;

/// A vibration as strong as the force: a continuous event whose intensity is the magnitude of the
/// force as a fraction of the full scale, along straight lines that differ from it by at most
/// `tolerance`, and half of 1e-3. A telephone has neither directions nor torque, so both are lost.
/// Magnitudes beyond the full scale are clipped, and NaN becomes 0. The description says which
/// force an intensity of 1 stands for, if the samples have been multiplied by `gain`.
///
/// Source: Apple, "Representing haptic patterns in AHAP files", and CHHapticEvent.duration: an
/// event lasts 30 s at most. Users report that only the first 16 points of a curve are used.
void write_ahap(const SampleSource& samples, const WriteText& write,
                double tolerance = kAhapTolerance, double gain = 1);

}  // namespace spidar
