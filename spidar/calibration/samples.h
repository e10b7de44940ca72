// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the counts of a grip that is moved or held, and prepares them for calibration.
#pragma once

#include <functional>
#include <vector>

#include "core/grip/string_geometry.h"
#include "spidar/calibration/calibration.h"
#include "spidar/calibration/model.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Throws std::invalid_argument that names what is wrong with the samples.
void check_samples(const Profile& profile, const CountSamples& counts, int min_strings);

/// Standard deviation of a length that is rounded to counts, as the mean of all strings, when
/// `averaged` samples are averaged. If the grip moves in between, it decreases with the square root
/// of their number; that is assumed for up to four samples.
double rounding_sd_m(const Profile& profile, double averaged);

/// Change of lengths since zero count. Successive samples that agree to a third of a millimetre are
/// averaged: a grip that stands still gives the same information however often it is read, and
/// neither noise nor rounding, which is the same each time, must count as motion.
std::vector<StringVector> distinct_lengths_m(const CalibrationModel& model,
                                             const CountSamples& counts);

/// The pose at which the counters are zero.
Pose pose_at_zero_count(const StringGeometry& geometry, const StringVector& home_offset_m);

struct RecordingSettings {
  double seconds = 20;             ///< > 0
  double sample_period_s = 0.002;  ///< at least one tick, which is a millisecond
};

/// Called before every exchange with the time since recording began, which is negative while the
/// strings are being energised. Waits until that time. Returning false ends the recording.
using NextTick = std::function<bool(double time_s)>;

/// Opens the device and sets the strings to their minimum tension, which keeps them taut without a
/// deliberate force on the hand. Then reads counts once a millisecond and stores one row in each
/// sample period. In every case, a ramp releases the strings at the end, and the device is closed.
/// Failed exchanges give no sample.
///
/// Throws DeviceError when the device cannot be opened or is lost, and whatever `next_tick` throws.
CountSamples record_counts(Device& device, const Profile& profile,
                           const RecordingSettings& settings, const NextTick& next_tick);

}  // namespace spidar
