// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/grip/grip_motion.h"

#include <algorithm>
#include <cmath>

namespace spidar {

void GripMotion::see(const Pose& pose, int64_t at_ns) noexcept {
  const double dt_s = 1e-9 * static_cast<double>(at_ns - at_ns_);
  if (started_ && !(dt_s > 0)) return;
  if (started_) {
    std::copy_backward(velocity_.begin(), velocity_.end() - 1, velocity_.end());
    const double share = share_passed(dt_s, 1 / (2 * M_PI * kCutoff_Hz));
    const Eigen::Quaterniond turn = pose.orientation * last_.orientation.conjugate();
    // For the small angles of a tick the rotation vector is twice the vector part.
    const Eigen::Vector3d turn_rad = (turn.w() < 0 ? -2.0 : 2.0) * turn.vec();
    GripVelocity& now = velocity_[0];
    now.linear_m_s += share * ((pose.position_m - last_.position_m) / dt_s - now.linear_m_s);
    now.angular_rad_s += share * (turn_rad / dt_s - now.angular_rad_s);
    dt_s_ = dt_s;
  }
  started_ = true;
  at_ns_ = at_ns;
  last_ = pose;
}

Pose GripMotion::pose_in(const Pose& pose, double ahead_s) const noexcept {
  Eigen::Quaterniond turn;
  turn.w() = 1;
  turn.vec() = 0.5 * ahead_s * velocity().angular_rad_s;
  return {pose.position_m + ahead_s * velocity().linear_m_s,
          (turn * pose.orientation).normalized()};
}

GripVelocity GripMotion::velocity_in(double ahead_s) const noexcept {
  const GripVelocity& now = velocity_.front();
  const GripVelocity& before = velocity_.back();
  const double slopes = (ahead_s + kLag_s) / (kSlope * dt_s_);
  return {now.linear_m_s + slopes * (now.linear_m_s - before.linear_m_s),
          now.angular_rad_s + slopes * (now.angular_rad_s - before.angular_rad_s)};
}

}  // namespace spidar
