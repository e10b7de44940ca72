// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What calibration accepts, and what it makes of it first.
#pragma once

#include <vector>

#include "core/grip/string_geometry.h"
#include "spidar/calibration/calibration.h"
#include "spidar/calibration/model.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Throws std::invalid_argument that says what is wrong with the samples.
void check_samples(const Profile& profile, const CountSamples& counts, int min_strings);

/// Standard deviation of a length that is rounded to counts, the mean of all strings, when
/// `averaged` of them are averaged: less by the root of that if the grip moves in between, which is
/// trusted up to four.
double rounding_sd_m(const Profile& profile, double averaged);

/// Change of lengths since zero count, neighbours that are the same to a third of a millimetre
/// averaged: a grip that stands still tells one thing, however often it is read, and neither noise
/// nor rounding, which is the same each time, may pass for motion.
std::vector<StringVector> distinct_lengths_m(const CalibrationModel& model,
                                             const CountSamples& counts);

/// Where the counters are zero.
Pose pose_at_zero_count(const StringGeometry& geometry, const StringVector& home_offset_m);

}  // namespace spidar
