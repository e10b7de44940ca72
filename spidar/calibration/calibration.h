// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where the strings' lengths stand when the counters are zero: encoders are incremental and boards
/// have no homing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Encoder counts as the board gives them: a row for each sample in the order of time, a column for
/// each string.
using CountSamples = Eigen::MatrixXd;

/// What is estimated besides the offsets.
struct CalibrationSettings {
  bool free_exits = false;  ///< where the strings leave the frame
  bool free_scale = false;  ///< one factor on every metres_per_count
};

enum class CalibrationStatus {
  kSolved,
  /// The motion does not tell everything that was asked for: see `undetermined`.
  kUndetermined,
  /// No values make the lengths agree, or what is left of them is not noise: the geometry or the
  /// scale is wrong, a string slips, or the counters were cleared too far from the centre.
  kContradiction,
};

/// Direction in the space of the numbers asked for in which the samples hardly tell anything.
struct UndeterminedCombination {
  /// Standard deviation along it; infinite when nothing depends on it.
  double sd_m = 0;
  /// Like "0.71 offset 2 − 0.71 offset 6": the largest of its coefficients.
  std::string text;
};

struct CalibrationResult {
  CalibrationStatus status = CalibrationStatus::kContradiction;
  CalibrationSettings estimated;  ///< what was asked for besides the offsets

  /// Length at zero count minus length at the centre, as in StringDrive::home_offset_m; the latter
  /// of the exits below.
  StringVector home_offset_m = StringVector::Zero();
  double scale = 1;  ///< factor on every metres_per_count
  /// Exits in D. Free ones neither shift nor turn as a whole against the profile's: that would be
  /// another choice of D.
  std::array<Eigen::Vector3d, kMaxStrings> exit_m{};

  /// Standard deviations (infinite when undetermined, zero when not asked for): of the lengths at
  /// zero count, the scale, and the exits. Errors that successive samples share, as those of a
  /// wrong geometry, count for what they are. All take the numbers of the profile that were not
  /// asked for as exact.
  StringVector home_offset_sd_m = StringVector::Zero();
  double scale_sd = 0;
  Eigen::Matrix<double, 3, kMaxStrings> exit_sd_m =
      Eigen::Matrix<double, 3, kMaxStrings>::Zero();  ///< a column for each string
  /// Root mean square error of the lengths at zero count when those numbers are not exact: exits
  /// and points on the grip to 1 mm a coordinate, the scale of each string to 0.5 %, its stretch
  /// included. Less where what is left of the lengths says so. Infinite when undetermined, and
  /// after calibrate_at_centre(), which has nothing to tell from.
  StringVector home_offset_uncertainty_m = StringVector::Zero();

  /// Where the grip was when the counters were zero.
  Pose cleared_at;

  int samples = 0;        ///< used: neighbours that are alike are averaged
  double residual_m = 0;  ///< root mean square length error over samples and strings, the outliers
                          ///< too; PoseResult::residual_m is the same of one sample
  double length_noise_m = 0;  ///< standard deviation of one length, outliers set aside
  double outlier_share = 0;   ///< samples whose strings contradict each other
  StringVector string_residual_m = StringVector::Zero();  ///< root mean square of each string
  /// How far the grip was moved and turned: half the range per axis of D.
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();

  std::vector<UndeterminedCombination> undetermined;  ///< the worst first
};

/// What a combination may be uncertain by (standard deviation): as much as PoseSolver takes for an
/// error of a length. What is known less well is `undetermined`.
inline constexpr double kMaxCalibrationSd_m = 50e-6;

/// Fewest samples of moving and of holding.
inline constexpr int kMinCalibrationSamples = 20;

/// From a grip that is moved and turned about. Eight lengths and six unknowns a sample leave two
/// equations for what all samples share: bundle adjustment of poses and shared parameters, robust
/// (Huber) on the samples, from several starts. The counters may have been cleared anywhere within
/// some 5 cm and 60 degrees of the centre.
///
/// Throws std::invalid_argument when the profile has fewer than seven strings, or a count is not
/// finite, or there are fewer than kMinCalibrationSamples, or not as many columns as strings.
SPIDAR_API CalibrationResult calibrate(const Profile& profile, const CountSamples& counts,
                                       const CalibrationSettings& settings = {});

/// From a grip that is held still at the centre, unturned: offsets only. Their standard deviation
/// is that of the counts; how well the hand found the centre it cannot know.
///
/// Throws std::invalid_argument as calibrate(), with any number of strings, and when a count moves
/// by more than kMaxHeldRange_m.
SPIDAR_API CalibrationResult calibrate_at_centre(const Profile& profile,
                                                 const CountSamples& counts);

/// A hand that holds still trembles less.
inline constexpr double kMaxHeldRange_m = 3e-3;

/// The profile with what was found, its standard deviations, residual and provenance. `how` is for
/// the provenance, like "moved for 20 s". Throws std::invalid_argument unless the status is
/// kSolved.
SPIDAR_API Profile calibrated_profile(const Profile& profile, const CalibrationResult& result,
                                      const std::string& how);

}  // namespace spidar
