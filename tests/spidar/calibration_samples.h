// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Counts of devices that differ slightly from their profiles.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include <Eigen/Geometry>

#include "spidar/calibration/calibration.h"
#include "spidar/calibration/samples.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double largest) {
  return std::uniform_real_distribution<double>(-largest, largest)(random);
}

inline Eigen::Vector3d uniform_vector(Random& random, double largest) {
  return {uniform(random, largest), uniform(random, largest), uniform(random, largest)};
}

/// The device's counters are zero where the grip is at `pose`.
inline void clear_counters_at(const Pose& pose, Profile& device) {
  const StringVector offset_m =
      string_lengths_m(device.geometry, pose) - string_lengths_m(device.geometry, {});
  for (int i = 0; i < device.geometry.count; ++i)
    device.drives[static_cast<size_t>(i)].home_offset_m = offset_m[i];
}

/// Off the centre by up to `reach_m` an axis and turned by up to `turn_rad`.
inline Pose wrong_start(Random& random, double reach_m, double turn_rad) {
  Pose pose;
  pose.position_m = uniform_vector(random, reach_m);
  pose.orientation =
      Eigen::AngleAxisd(uniform(random, turn_rad), uniform_vector(random, 1).normalized());
  return pose;
}

inline void add_to_offsets(Random& random, double largest_m, Profile& device) {
  for (int i = 0; i < device.geometry.count; ++i)
    device.drives[static_cast<size_t>(i)].home_offset_m += uniform(random, largest_m);
}

/// Rounded counts of `device` with normal noise of `noise_counts` before rounding, at the poses
/// that `pose_at` gives for the time in seconds.
inline calibration::CountSamples counts_of(const Profile& device, int samples, double period_s,
                                           Random& random, double noise_counts,
                                           const std::function<Pose(double)>& pose_at) {
  std::normal_distribution<double> normal;
  const int strings = device.geometry.count;
  const StringVector zero_m = device.zero_count_length_m();
  calibration::CountSamples counts(samples, strings);
  for (int k = 0; k < samples; ++k) {
    const StringVector length_m = string_lengths_m(device.geometry, pose_at(k * period_s));
    for (int i = 0; i < strings; ++i) {
      const StringDrive& drive = device.drives[static_cast<size_t>(i)];
      const double exact = (length_m[i] - zero_m[i]) / drive.metres_per_count;
      counts(k, i) = drive.encoder_sign * std::round(exact + noise_counts * normal(random));
    }
  }
  return counts;
}

/// The same with the hand of `spidarctl calibrate sim`.
inline calibration::CountSamples moved_counts(const Profile& device, int samples, double period_s,
                                              Random& random, double noise_counts) {
  const double phase_rad = uniform(random, M_PI);
  return counts_of(device, samples, period_s, random, noise_counts, [&](double time_s) {
    return calibration::hand_in_motion(device.geometry, time_s, phase_rad);
  });
}

/// Error of the lengths at zero count, for any choice of D.
inline StringVector zero_length_errors_m(const Profile& profile, const Profile& device,
                                         const calibration::Result& result) {
  StringGeometry found = profile.geometry;
  found.exit_m = result.exit_m;
  return string_lengths_m(found, {}) + result.home_offset_m - device.zero_count_length_m();
}

}  // namespace spidar::test
