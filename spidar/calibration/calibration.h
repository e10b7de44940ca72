// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Determines the lengths of the strings at which the counters are zero, because encoders are
/// incremental and boards have no homing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Encoder counts as read from the board: a row for each sample in the order of time, a column for
/// each string.
using CountSamples = Eigen::MatrixXd;

/// Parameters that are estimated in addition to the offsets.
struct CalibrationSettings {
  bool free_exits = false;  ///< the points at which the strings leave the frame
  bool free_scale = false;  ///< one factor on every metres_per_count
};

enum class CalibrationStatus {
  kSolved,
  /// The motion does not determine everything that was asked for; see `undetermined`.
  kUndetermined,
  /// No values make the lengths agree, or their remaining errors are not noise: the geometry or the
  /// scale is wrong, a string slips, or the counters were cleared too far from the centre.
  kContradiction,
};

/// Direction in the space of the estimated parameters that the samples hardly determine.
struct UndeterminedCombination {
  /// Standard deviation along this direction; infinite if no length depends on it.
  double sd_m = 0;
  /// The largest coefficients, for example "0.71 offset 2 − 0.71 offset 6".
  std::string text;
};

struct CalibrationResult {
  CalibrationStatus status = CalibrationStatus::kContradiction;
  CalibrationSettings estimated;  ///< what was estimated in addition to the offsets

  /// Length at zero count minus length at the centre, as in StringDrive::home_offset_m. The length
  /// at the centre is that for the exits below.
  StringVector home_offset_m = StringVector::Zero();
  double scale = 1;  ///< factor on every metres_per_count
  /// Exits in D. Free exits neither shift nor turn as a whole relative to those of the profile,
  /// because that would be a different choice of D.
  std::array<Eigen::Vector3d, kMaxStrings> exit_m{};

  /// Standard deviations (infinite when undetermined, zero when not asked for): of the lengths at
  /// zero count, the scale, and the exits. They account for errors that successive samples share,
  /// such as those of a wrong geometry. All assume that the other numbers of the profile are exact.
  StringVector home_offset_sd_m = StringVector::Zero();
  double scale_sd = 0;
  Eigen::Matrix<double, 3, kMaxStrings> exit_sd_m =
      Eigen::Matrix<double, 3, kMaxStrings>::Zero();  ///< a column for each string
  /// Expected root mean square error of the lengths at zero count if those numbers are not exact:
  /// exits and points on the grip to 1 mm in each coordinate, the scale of each string to 0.5 %,
  /// including its stretch. It is smaller if the remaining errors of the lengths indicate that.
  /// Infinite when undetermined, and after calibrate_at_centre(), which cannot estimate it.
  StringVector home_offset_uncertainty_m = StringVector::Zero();

  /// The pose of the grip at which the counters were zero.
  Pose cleared_at;

  int samples = 0;            ///< used; successive samples that agree are averaged
  double residual_m = 0;      ///< root mean square length error over samples and strings, including
                              ///< outliers; PoseResult::residual_m is the same for one sample
  double length_noise_m = 0;  ///< standard deviation of one length, without outliers
  double outlier_share = 0;   ///< share of samples whose strings contradict each other
  StringVector string_residual_m = StringVector::Zero();  ///< root mean square error of each string
  /// How far the grip was moved and turned: half the range for each axis of D.
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();

  std::vector<UndeterminedCombination> undetermined;  ///< the worst first
};

/// Largest permitted standard deviation of a combination, equal to the error of a length that
/// PoseSolver treats as a fault. Combinations with a larger one are `undetermined`.
inline constexpr double kMaxCalibrationSd_m = 50e-6;

/// Minimum number of samples, both for a moved and for a held grip.
inline constexpr int kMinCalibrationSamples = 20;

/// Calibrates from a grip that is moved and turned about. A sample has eight lengths and its pose
/// six unknowns, which leaves two equations for the parameters that all samples share. Uses bundle
/// adjustment of poses and shared parameters, robust (Huber) on the samples, from several starts.
/// The counters may have been cleared anywhere within some 5 cm and 60 degrees of the centre.
///
/// Throws std::invalid_argument when the profile has fewer than seven strings, or a count is not
/// finite, or there are fewer than kMinCalibrationSamples, or not as many columns as strings.
CalibrationResult calibrate(const Profile& profile, const CountSamples& counts,
                            const CalibrationSettings& settings = {});

/// Calibrates only the offsets, from a grip that is held still at the centre without rotation.
/// Their standard deviation is that of the counts; it does not include how accurately the hand
/// found the centre.
///
/// Throws std::invalid_argument as calibrate(), with any number of strings, and when a count moves
/// by more than kMaxHeldRange_m.
CalibrationResult calibrate_at_centre(const Profile& profile, const CountSamples& counts);

/// Tremor of a hand that holds still is smaller than this.
inline constexpr double kMaxHeldRange_m = 3e-3;

/// Returns the profile with the result, its standard deviations, residual and provenance. `how`
/// describes the provenance, for example "moved for 20 s". Throws std::invalid_argument unless the
/// status is kSolved.
Profile calibrated_profile(const Profile& profile, const CalibrationResult& result,
                           const std::string& how);

}  // namespace spidar
