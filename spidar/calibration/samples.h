// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the counts of a grip that is moved or held, and prepares them for calibration.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "core/grip/string_geometry.h"
#include "spidar/calibration/calibration.h"
#include "spidar/calibration/model.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar::calibration {

/// Throws std::invalid_argument, which says what is wrong with the samples.
void check_samples(const Profile& profile, const CountSamples& counts, int min_strings);

/// Standard deviation of a rounded length, as the mean of all strings, when `averaged` samples are
/// averaged. Rounding errors of up to four samples count as independent.
double rounding_sd_m(const Profile& profile, double averaged);

/// Returns the change of the lengths since zero count. Averages successive samples that agree to a
/// third of a millimetre: a grip that stands still gives the same information however often it is
/// read, and neither noise nor a rounding error, which is the same each time, may count as motion.
std::vector<StringVector> distinct_lengths_m(const Model& model, const CountSamples& counts);

/// The pose at which the counters are zero.
Pose pose_at_zero_count(const StringGeometry& geometry, const StringVector& home_offset_m);

/// Opens the device and sets the strings to their minimum tension, which keeps them taut without a
/// noticeable force. Then reads counts once a millisecond for `seconds` and stores one row in each
/// sample period, which lasts a millisecond or longer. `next_tick` is called before each exchange
/// with the time since recording began, which is negative while the strings are being tightened.
/// `next_tick` waits until that time, and returns false to end the recording. In every case, a ramp
/// releases the strings at the end, and the device is closed. Failed exchanges give no sample.
///
/// Throws DeviceError when the device cannot be opened or is lost, and whatever `next_tick` throws.
CountSamples record_counts(StringDevice& device, const Profile& profile, double seconds,
                           double sample_period_s,
                           const std::function<bool(double time_s)>& next_tick);

/// A hand that moves and rotates in all six directions at once, with incommensurable periods of
/// about two to four seconds: by up to 0.4 of the frame's half-width and 0.45 rad in each
/// direction. The grip is at the centre up to `time_s` = 0. `phase_rad` varies the motion.
inline Pose hand_in_motion(const StringGeometry& geometry, double time_s, double phase_rad = 0) {
  constexpr double kFraction = 0.4, kTurn_rad = 0.45, kFadeIn_s = 1.0;
  constexpr double kRate_Hz[6] = {0.437, 0.361, 0.281, 0.251, 0.319, 0.397};
  const double grown = std::clamp(time_s / kFadeIn_s, 0.0, 1.0);
  const auto wave = [&](int i) {
    return grown * std::sin(2 * M_PI * kRate_Hz[i] * time_s + phase_rad * (1 + i));
  };
  Pose pose;
  pose.position_m =
      kFraction * half_frame_m(geometry).minCoeff() * Eigen::Vector3d(wave(0), wave(1), wave(2));
  const Eigen::Vector3d turn = kTurn_rad * Eigen::Vector3d(wave(3), wave(4), wave(5));
  if (turn.norm() > 0) pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return pose;
}

}  // namespace spidar::calibration
