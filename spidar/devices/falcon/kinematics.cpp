// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/falcon/kinematics.h"

#include <array>
#include <cmath>

#include <Eigen/LU>

namespace spidar::falcon {
namespace {

// Lengths in metres, by the letters of Stamper's figure.
constexpr double kUpperArm_m = 0.060;    // a
constexpr double kRods_m = 0.1025;       // b, of the parallelogram
constexpr double kHinges_m = 0.0225;     // d + e, between the rods' ends and their axes
constexpr double kGripOut_m = 0.01443;   // c, from the rods to the middle of the grip, outwards
constexpr double kGripAside_m = -0.025;  // f, from the rods to the middle of the grip, sideways
constexpr double kBaseOut_m = 0.0400;    // r, from the middle of the base to an arm's axis
// S, from the middle of the base to an arm's axis, sideways.
constexpr double kBaseAside_m = -0.02309;
constexpr double kFirstArm_rad = M_PI / 2 + M_PI / 12;  // the others follow clockwise

constexpr double kStepDone_m = 1e-9;  ///< doubles do not resolve the constraints below this step
/// Rows whose |det| is smaller count as dependent: within kReach_m the |det| is above 0.17.
constexpr double kMinDeterminant = 0.05;

/// Rotations from the device frame to the frame of each arm, with rows u outwards, v sideways, w
/// towards the hand.
std::array<Eigen::Matrix3d, 3> make_turns() noexcept {
  std::array<Eigen::Matrix3d, 3> turns;
  for (size_t i = 0; i < turns.size(); ++i) {
    const double at_rad = kFirstArm_rad - static_cast<double>(i) * 2 * M_PI / 3;
    const double c = std::cos(at_rad), s = std::sin(at_rad);
    turns[i] << c, s, 0, -s, c, 0, 0, 0, 1;
  }
  return turns;
}

const Eigen::Matrix3d& turn_to(int arm) noexcept {
  static const std::array<Eigen::Matrix3d, 3> turns = make_turns();
  return turns[static_cast<size_t>(arm)];
}

/// The far end of an arm's rods, from the axis of the arm, in the arm's frame.
Eigen::Vector3d rods_end_m(int arm, const Eigen::Vector3d& position_m) noexcept {
  return turn_to(arm) * position_m +
         Eigen::Vector3d(kGripOut_m - kBaseOut_m, kGripAside_m - kBaseAside_m, kCentre_m);
}

/// The length that the rods span in the plane of the arm, which they shorten by leaning sideways by
/// v. Not a number where they cannot lean that far.
double span_m(double v_m) noexcept {
  return kHinges_m + std::sqrt(kRods_m * kRods_m - v_m * v_m);
}

/// In the plane of each arm, the far end of the rods is at the distance span_m() from the knee:
/// value = |end − knee|² − span² is zero.
struct Constraints {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_position;  ///< one row per constraint: its gradient in the device frame, m
  Eigen::Vector3d by_angle;     ///< m²/rad; negative unless the arm is stretched or bent back
};

Constraints constraints_of(const Eigen::Vector3d& angles_rad,
                           const Eigen::Vector3d& position_m) noexcept {
  Constraints all;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d end = rods_end_m(i, position_m);
    const double c = std::cos(angles_rad[i]), s = std::sin(angles_rad[i]);
    const double u = end.x() - kUpperArm_m * c, v = end.y(), w = end.z() - kUpperArm_m * s;
    const double span = span_m(v);
    all.value[i] = u * u + w * w - span * span;
    // d span / d v = −v / (span − hinges)
    all.by_position.row(i) =
        Eigen::RowVector3d(2 * u, 2 * span * v / (span - kHinges_m), 2 * w) * turn_to(i);
    all.by_angle[i] = 2 * kUpperArm_m * (end.x() * s - end.z() * c);
  }
  return all;
}

/// Returns nothing when the rows depend on each other or are not numbers.
std::optional<Eigen::Matrix3d> inverse_of(const Eigen::Matrix3d& rows) noexcept {
  const double independent = std::abs(rows.rowwise().normalized().determinant());
  if (!(independent > kMinDeterminant)) return std::nullopt;
  return rows.inverse();
}

bool within_range(const Eigen::Vector3d& angles_rad) noexcept {
  return (angles_rad.array() >= kMinAngle_rad).all() && (angles_rad.array() <= kMaxAngle_rad).all();
}

}  // namespace

std::optional<Eigen::Vector3d> arm_angles(const Eigen::Vector3d& position_m) noexcept {
  Eigen::Vector3d angles_rad;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d end = rods_end_m(i, position_m);
    const double span = span_m(end.y()), reach_m = std::hypot(end.x(), end.z());
    // Law of cosines in the triangle of axis, knee and rods' end, with the knee on the outside.
    const double cosine =
        (kUpperArm_m * kUpperArm_m + reach_m * reach_m - span * span) / (2 * kUpperArm_m * reach_m);
    if (!(std::abs(cosine) < 1)) return std::nullopt;
    angles_rad[i] = std::atan2(end.z(), end.x()) - std::acos(cosine);
  }
  if (!within_range(angles_rad)) return std::nullopt;
  return angles_rad;
}

std::optional<Eigen::Vector3d> grip_position(const Eigen::Vector3d& angles_rad) noexcept {
  if (!within_range(angles_rad)) return std::nullopt;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  for (int step = 0; step < kMaxSteps; ++step) {
    const Constraints now = constraints_of(angles_rad, position_m);
    const auto inverse = inverse_of(now.by_position);
    if (!inverse) return std::nullopt;
    const Eigen::Vector3d step_m = *inverse * now.value;
    position_m -= step_m;
    if (step_m.norm() > kStepDone_m) continue;
    if ((now.by_angle.array() < 0).all()) return position_m;
    return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Eigen::Matrix3d> jacobian(const Eigen::Vector3d& angles_rad,
                                        const Eigen::Vector3d& position_m) noexcept {
  const Constraints now = constraints_of(angles_rad, position_m);
  const auto inverse = inverse_of(now.by_position);
  if (!inverse) return std::nullopt;
  return Eigen::Matrix3d(-*inverse * now.by_angle.asDiagonal());
}

}  // namespace spidar::falcon
