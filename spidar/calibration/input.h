// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Checks and prepares the input of calibration.
#pragma once

#include <vector>

#include "core/grip/string_geometry.h"
#include "spidar/calibration/calibration.h"
#include "spidar/calibration/model.h"
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

}  // namespace spidar
