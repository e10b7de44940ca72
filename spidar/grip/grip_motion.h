// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The velocity of the grip.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"

namespace spidar {

/// 1 − exp(−x) for x = `dt_s` / `time_s`: the fraction of the way that a first-order low-pass goes.
/// By a series of the third order, because a tick needs five of them; at x = 0.5 it is 0.3 % less.
inline double fraction_passed(double dt_s, double time_s) noexcept {
  if (!(time_s > 0)) return 1;
  const double x = dt_s / time_s;
  return 1 - 1 / (1 + x * (1 + x * (0.5 + x / 6)));
}

/// Linear and angular velocity in the device frame.
struct GripVelocity {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// Estimates the velocity from one pose a tick, by differences and a first-order low-pass.
///
/// The estimate is kLag_s behind the newest pose. A coordinate with independent errors of standard
/// deviation σ has a velocity with an error of 0.25 σ per tick; an encoder step of 20 µm (σ = 6 µm)
/// gives 1.5 mm/s.
class GripMotion {
 public:
  static constexpr double kCutoff_Hz = 60;
  /// Half a tick of the difference, and the time constant of the low-pass.
  static constexpr double kLag_s = 0.5e-3 + 1 / (2 * M_PI * kCutoff_Hz);

  /// The grip was at `pose` at `at_ns`. The same time again is no new pose.
  void see(const Pose& pose, int64_t at_ns) noexcept {
    const double dt_s = 1e-9 * static_cast<double>(at_ns - at_ns_);
    if (started_ && !(dt_s > 0)) return;
    if (started_) {
      std::copy_backward(velocity_.begin(), velocity_.end() - 1, velocity_.end());
      const double fraction = fraction_passed(dt_s, 1 / (2 * M_PI * kCutoff_Hz));
      const Eigen::Quaterniond turn = pose.orientation * last_.orientation.conjugate();
      // For the small angles of a tick the rotation vector is twice the vector part.
      const Eigen::Vector3d turn_rad = (turn.w() < 0 ? -2.0 : 2.0) * turn.vec();
      GripVelocity& now = velocity_[0];
      now.linear_m_s += fraction * ((pose.position_m - last_.position_m) / dt_s - now.linear_m_s);
      now.angular_rad_s += fraction * (turn_rad / dt_s - now.angular_rad_s);
      dt_s_ = dt_s;
    }
    started_ = true;
    at_ns_ = at_ns;
    last_ = pose;
  }

  /// The pose is not known: the velocity is zero until there are two poses again.
  void reset() noexcept { *this = {}; }

  const GripVelocity& velocity() const noexcept { return velocity_[0]; }

  /// Where a grip at `pose` is `ahead_s` later at the present velocity.
  Pose pose_in(const Pose& pose, double ahead_s) const noexcept {
    Eigen::Quaterniond turn;
    turn.w() = 1;
    turn.vec() = 0.5 * ahead_s * velocity().angular_rad_s;
    return {pose.position_m + ahead_s * velocity().linear_m_s,
            (turn * pose.orientation).normalized()};
  }

  /// The velocity `ahead_s` after the newest pose, with the present acceleration.
  GripVelocity velocity_in(double ahead_s) const noexcept {
    const GripVelocity& now = velocity_.front();
    const GripVelocity& before = velocity_.back();
    const double slopes = (ahead_s + kLag_s) / (kSlope * dt_s_);
    return {now.linear_m_s + slopes * (now.linear_m_s - before.linear_m_s),
            now.angular_rad_s + slopes * (now.angular_rad_s - before.angular_rad_s)};
  }

 private:
  static constexpr int kSlope = 3;  ///< ticks over which the acceleration is measured

  bool started_ = false;
  int64_t at_ns_ = 0;
  double dt_s_ = 1e-3;
  Pose last_;
  std::array<GripVelocity, kSlope + 1> velocity_;  ///< latest first
};

}  // namespace spidar
