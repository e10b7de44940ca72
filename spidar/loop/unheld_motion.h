// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "spidar/grip/grip_motion.h"
#include "spidar/loop/brake_table.h"

namespace spidar::brake {

/// Recognises a grip that moves as the strings alone would move it. Compares the change of its
/// velocity in the last kMemory_s with the change that the strings would have caused in a grip of
/// kUnheldGrip_kg in no hand.
class UnheldMotion {
 public:
  void reset() noexcept { *this = {}; }
  /// Adds the force `acting_N`, which the strings have exerted for `dt_s`.
  void pull(const Eigen::Vector3d& acting_N, double dt_s) noexcept {
    late_N_ += fraction_passed(dt_s, GripMotion::kLag_s) * (acting_N - late_N_);
    given_m_s_ += dt_s / kUnheldGrip_kg * late_N_;
    given_m_s_ *= 1 - fraction_passed(dt_s, kMemory_s);
  }
  /// Adds the velocity of the grip, `dt_s` after the last call.
  void update(const Eigen::Vector3d& velocity_m_s, double dt_s) noexcept {
    seen_m_s_ += velocity_m_s - last_m_s_;
    seen_m_s_ *= 1 - fraction_passed(dt_s, kMemory_s);
    last_m_s_ = velocity_m_s;
  }

  /// Whether the two changes have about the same size and direction.
  bool is_recognised() const noexcept {
    const double seen_m_s = seen_m_s_.norm(), given_m_s = given_m_s_.norm();
    return seen_m_s >= kMinFraction * given_m_s && seen_m_s <= kMaxFraction * given_m_s &&
           seen_m_s_.dot(given_m_s_) >= kAligned * seen_m_s * given_m_s;
  }

 private:
  /// The acting force, with the lag of the velocity.
  Eigen::Vector3d late_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d given_m_s_ = Eigen::Vector3d::Zero();  ///< change computed from the force
  Eigen::Vector3d seen_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_m_s_ = Eigen::Vector3d::Zero();
};

}  // namespace spidar::brake
