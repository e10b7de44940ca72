// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The description of a device: geometry, motors, encoders, the source of each number.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/default_limits.h"
#include "core/grip/string_geometry.h"
#include "spidar/profiles/grip_body.h"

namespace spidar {

/// Thrown for an unusable profile. what() names file, line and field, the error and the remedy.
class ProfileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Profile::board of a profile whose source names no board: any board may fit.
constexpr const char* kUnknownBoard = "unknown";

struct StringDrive {
  double min_tension_N = 0;  ///< keeps the string taut
  double max_tension_N = 0;
  double newtons_per_volt = 0;  ///< > 0; the sign is in motor_sign
  double metres_per_count = 0;  ///< > 0; the sign is in encoder_sign
  int motor_sign = 1;           ///< +1: a positive voltage pulls
  int encoder_sign = 1;         ///< +1: the count rises when string is paid out
  /// Length at zero count minus length with the grip at the centre: 0 if the grip was at the centre
  /// when the board's counters were cleared. Valid until the counters are cleared again.
  double home_offset_m = 0;
  /// The tension that the motor can exert continuously without overheating, N. 0 means that the
  /// source does not state it; half of max_tension_N is used.
  double continuous_tension_N = 0;
  double heating_time_s = kHeatingTime_s;  ///< time constant of the winding's temperature, s

  static constexpr double kHeatingTime_s = 20;

  double continuous_N() const noexcept {
    return continuous_tension_N > 0 ? continuous_tension_N : max_tension_N / 2;
  }
};

enum class Evidence {
  kPublished,     ///< read in the source
  kInferred,      ///< derived or plausible; check on the device
  kContradicted,  ///< read in the source, but another source contradicts it
  kMeasured,      ///< measured on this device, by calibration
};

/// The source of a group of numbers.
struct Provenance {
  std::string field;   ///< e.g. "geometry", "newtons_per_volt"
  std::string source;  ///< e.g. "haselab-net/SpringheadOne src/HIS/HISpidarG6C.cpp"
  Evidence evidence = Evidence::kPublished;
  std::string note;  ///< how it was derived, or what contradicts it; may be empty
};

/// How well calibrated numbers fit.
struct CalibrationRecord {
  int samples = 0;
  double residual_m = 0;  ///< root mean square length error of all samples
};

struct Profile {
  /// The lag of a drive if the profile states none; no public source states one.
  static constexpr double kDriveLag_s = 0.002;

  std::string name;         ///< file name without ending
  std::string description;  ///< one line
  std::string board;        ///< the kind of board, see parse_profile()
  StringGeometry geometry;  ///< in D (the files' left-handed tables are converted when read)
  std::array<StringDrive, kMaxStrings> drives{};  ///< geometry.count are used
  int dac_bits = 12;        ///< resolution of the D/A converters over dac_max_V
  double dac_max_V = 10.0;  ///< the range is 0 … this, times motor_sign
  /// Lag from a command to the tension, s: amplifier, motor, and the delay of the board.
  double drive_lag_s = kDriveLag_s;
  bool drive_lag_known = false;  ///< whether the file or a simulation states the lag
  /// Principal moments of inertia of the grip alone; zero: not stated.
  Eigen::Vector3d moment_of_inertia_kg_m2 = Eigen::Vector3d::Zero();
  std::optional<CalibrationRecord> calibration;
  std::vector<Provenance> provenance;

  /// The inertia of the grip, as stated or else inferred.
  GripBody body() const {
    GripBody body = GripBody::inferred(geometry.grip_radius_m());
    if (moment_of_inertia_kg_m2.isZero(0)) return body;
    body.least_kg_m2 = moment_of_inertia_kg_m2.minCoeff();
    body.most_kg_m2 = moment_of_inertia_kg_m2.maxCoeff();
    return body;
  }

  /// Lengths at which the counters are zero: those at the centre plus home_offset_m.
  StringVector zero_count_length_m() const {
    return string_lengths_m(geometry, {}) + per_string<&StringDrive::home_offset_m>();
  }
  StringVector min_tension_N() const { return per_string<&StringDrive::min_tension_N>(); }
  StringVector max_tension_N() const { return per_string<&StringDrive::max_tension_N>(); }
  /// The largest residual (root mean square) of a correct pose, for PoseSolver: one step of the
  /// coarsest encoder. Counts are off by half a step at most; the rest is for the geometry.
  double max_pose_residual_m() const {
    return per_string<&StringDrive::metres_per_count>().maxCoeff();
  }

 private:
  template <double StringDrive::*kMember>
  StringVector per_string() const {
    StringVector values = StringVector::Zero();
    for (int i = 0; i < geometry.count; ++i) values[i] = drives[static_cast<size_t>(i)].*kMember;
    return values;
  }
};

/// Loads a name of list_profiles(), or a path, with a '/' or ending in .toml. Throws ProfileError.
Profile load_profile(const std::string& name_or_path);

/// Returns the profiles that load_profile() finds by name: those in $SPIDAR_PROFILE_PATH
/// (colon-separated), then the installed files, then those in the library. Sorted, without ending.
std::vector<std::string> list_profiles();

/// The desktop SPIDAR-G that is most common in public sources.
inline constexpr const char* kDefaultProfile = "spidar-gcc";

/// Returns how far the sum of `count` pulls, each from none to full, reaches in its weakest
/// direction. The reachable set is a zonotope, whose nearest face is parallel to two of the pulls.
/// −1 if all pulls lie in one line.
inline double least_reach(const Eigen::Matrix<double, 3, kMaxStrings>& pulls, int count) {
  double least = -1;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < i; ++k) {
      const Eigen::Vector3d across = pulls.col(i).cross(pulls.col(k));
      if (!(across.norm() > 0)) continue;
      const Eigen::Vector3d normal = across.normalized();
      for (const Eigen::Vector3d& towards : {normal, Eigen::Vector3d(-normal)}) {
        const double most = (towards.transpose() * pulls).cwiseMax(0).sum();
        least = least < 0 ? most : std::min(least, most);
      }
    }
  }
  return least;
}

/// The upper bound of a force limit: the force that the strings can exert at the centre in every
/// direction, and no less than kDefaultForce_N.
inline double largest_force_N(const Profile& profile) {
  return std::max(kDefaultForce_N, least_reach(structure_matrix(profile.geometry, {}).topRows<3>() *
                                                   profile.max_tension_N().asDiagonal(),
                                               profile.geometry.count));
}

/// The upper bound of a torque limit: the torque that the strings can exert at the centre about
/// every axis, and no less than kDefaultTorque_Nm.
inline double largest_torque_Nm(const Profile& profile) {
  return std::max(kDefaultTorque_Nm,
                  least_reach(structure_matrix(profile.geometry, {}).bottomRows<3>() *
                                  profile.max_tension_N().asDiagonal(),
                              profile.geometry.count));
}

}  // namespace spidar
