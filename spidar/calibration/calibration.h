// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Determines the lengths of the strings at zero count: encoders are incremental, without homing.
#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar::calibration {

/// Encoder counts as read from the board: one row per sample in time, one column per string.
using CountSamples = Eigen::MatrixXd;

/// The parameters that are estimated in addition to the offsets.
struct Settings {
  bool free_exits = false;  ///< the points at which the strings leave the frame
  bool free_scale = false;  ///< one factor on every metres_per_count
};

enum class Status {
  kSolved,
  kUndetermined,  ///< the motion does not determine all parameters that were requested
  /// No parameters make the lengths agree, or the remaining errors are not noise: the geometry or
  /// the scale is wrong, a string slips, or the first sample was too far from the centre.
  kContradiction,
};

struct Result {
  Status status = Status::kContradiction;
  Settings estimated;  ///< the parameters that were estimated in addition to the offsets

  /// Length at zero count minus that at the centre (StringDrive::home_offset_m), for the exits
  /// below.
  StringVector home_offset_m = StringVector::Zero();
  double scale = 1;  ///< factor on every metres_per_count
  /// Exits in D. Free exits neither shift nor turn as a whole relative to the profile's exits,
  /// because that would be a different choice of D.
  std::array<Eigen::Vector3d, kMaxStrings> exit_m{};

  Pose cleared_at;  ///< the pose of the grip at which the counters were zero

  int samples = 0;  ///< successive samples that agree are averaged and count once
  /// Root mean square length error over samples and strings, including outliers;
  /// PoseResult::residual_m is the same for one sample.
  double residual_m = 0;
  /// How far the grip was moved and turned: half the range for each axis of D.
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();
};

/// The largest permitted standard deviation of any combination of parameters: the length error that
/// PoseSolver treats as a fault.
inline constexpr double kMaxSd_m = 50e-6;

/// Minimum number of samples, both for a moved and for a held grip.
inline constexpr int kMinSamples = 20;

/// Calibrates from a grip that is moved and turned about. A sample has eight lengths and its pose
/// six unknowns, which leaves two equations for the parameters that all samples share. The method
/// is bundle adjustment of poses and shared parameters, robust (Huber) on the samples. The first
/// sample must be within some 2 cm and 20 degrees of the centre; the counters may start anywhere.
///
/// Throws std::invalid_argument when the profile has fewer than seven strings, when a count is not
/// finite, when there are fewer than kMinSamples samples, or when the columns are not as many as
/// the strings.
Result calibrate(const Profile& profile, const CountSamples& counts, const Settings& settings = {});

/// Calibrates only the offsets, from a grip that is held still at the centre without rotation. The
/// offsets are as accurate as the hand finds the centre.
///
/// Throws std::invalid_argument as calibrate() does, but accepts any number of strings. Also throws
/// when a count moves by more than kMaxHeldRange_m.
Result calibrate_at_centre(const Profile& profile, const CountSamples& counts);

/// The tremor of a hand that holds still is smaller than this.
inline constexpr double kMaxHeldRange_m = 3e-3;

/// Returns the profile with the result, its residual and provenance. `how` describes the
/// provenance: "moved for 20 s". Throws std::invalid_argument unless kSolved.
Profile calibrated_profile(const Profile& profile, const Result& result, const std::string& how);

}  // namespace spidar::calibration
