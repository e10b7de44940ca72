// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The three arms of the Novint Falcon, a delta robot: angles of the upper arms, position of the
/// grip, and torques for a force.
///
/// The mechanism is that of R. E. Stamper, "A three degree of freedom parallel manipulator with
/// only translational degrees of freedom", thesis, University of Maryland, 1997; the lengths are
/// those of libnifalcon, include/falcon/core/FalconGeometry.h, where they were measured. The
/// equations below are our own: each arm is one constraint, see constraint_of().
#pragma once

#include <optional>

#include <Eigen/Core>

namespace spidar::falcon {

/// How far the origin of the device frame is from that of libnifalcon, along the axis that points
/// from the base to the hand: the middle between the stops of the grip (inferred from its programs,
/// which use 0.075 to 0.175 m).
constexpr double kCentre_m = 0.125;

/// The grip reaches every position within this distance of the origin, m, as computed from the
/// lengths. A cube of 4 inches is often quoted.
constexpr double kReach_m = 0.055;

/// Range of an arm, radians. Within kReach_m, −0.65 to 1.5 are needed; the stops are not published
/// (inferred).
constexpr double kMinAngle_rad = -0.8;
constexpr double kMaxAngle_rad = 1.9;

/// Angles of the three upper arms, from the plane of the base towards the hand, radians, for the
/// grip at `position_m` in the device frame. Nothing if an arm cannot reach it.
std::optional<Eigen::Vector3d> arm_angles(const Eigen::Vector3d& position_m) noexcept;

/// The position of the grip, device frame, m; nothing if no position fits, or only one with a
/// bent-back arm. Uses Newton's method from the origin, which converges to every position within
/// kReach_m in kMaxSteps. Does not allocate.
std::optional<Eigen::Vector3d> grip_position(const Eigen::Vector3d& angles_rad) noexcept;
constexpr int kMaxSteps = 20;

/// ∂position/∂angles, m/rad. Nothing where the arms do not determine the motion of the grip.
std::optional<Eigen::Matrix3d> jacobian(const Eigen::Vector3d& angles_rad,
                                        const Eigen::Vector3d& position_m) noexcept;

}  // namespace spidar::falcon
