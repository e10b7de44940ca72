// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The three arms of the Novint Falcon, a delta robot: angles of the upper arms, position of the
/// grip, and torques for a force.
///
/// The mechanism is that of R. E. Stamper, "A three degree of freedom parallel manipulator with
/// only translational degrees of freedom", thesis, University of Maryland, 1997. The lengths are
/// those of libnifalcon, include/falcon/core/FalconGeometry.h, where they were measured. The
/// equations are our own: each arm is one constraint, see constraint_of().
#pragma once

#include <optional>

#include <Eigen/Core>

namespace spidar::falcon {

/// The distance from libnifalcon's origin to that of the device frame, along the axis from the base
/// to the hand: the middle between the stops of the grip (inferred from libnifalcon's programs,
/// which use 0.075 to 0.175 m).
constexpr double kCentre_m = 0.125;

/// The grip reaches every position within this distance of the origin, m, as computed from the
/// lengths. A cube of 4 inches is often quoted.
constexpr double kReach_m = 0.055;

/// The range of an arm, radians. Within kReach_m, −0.65 to 1.5 are needed; the stops are inferred,
/// because they are not published.
constexpr double kMinAngle_rad = -0.8;
constexpr double kMaxAngle_rad = 1.9;

/// Returns the angles of the three upper arms, from the plane of the base towards the hand,
/// radians, for the grip at `position_m` in the device frame. Returns nothing if an arm cannot
/// reach that position.
std::optional<Eigen::Vector3d> arm_angles(const Eigen::Vector3d& position_m) noexcept;

/// Returns the position of the grip in the device frame, m; nothing if no position fits, or only
/// one with a bent-back arm. Newton's method starts at the origin and converges to every position
/// within kReach_m in kMaxSteps. Does not allocate.
std::optional<Eigen::Vector3d> grip_position(const Eigen::Vector3d& angles_rad) noexcept;
constexpr int kMaxSteps = 20;

/// Returns ∂position/∂angles, m/rad; nothing where the arms do not determine the motion.
std::optional<Eigen::Matrix3d> jacobian(const Eigen::Vector3d& angles_rad,
                                        const Eigen::Vector3d& position_m) noexcept;

}  // namespace spidar::falcon
