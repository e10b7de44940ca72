// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Notices a surface that shakes the grip.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace spidar {

/// A surface that is too stiff for the lag of the drives shakes a grip that presses on it, at 15 to
/// 60 Hz, faster than a hand trembles. The velocity across the surface, less its slow part, then
/// changes its sign in even intervals. A tap has two or three such intervals. While the grip
/// strokes along the surface, the relief itself may shake it, so that this does not count.
class ShakeWatch {
 public:
  static constexpr double kSlowest_Hz = 15;
  static constexpr double kFastest_Hz = 60;
  /// The velocity must reach this between two changes of sign. A force of 0.5 N moves a grip of 0.3
  /// kg as fast at 30 Hz; the steps of an encoder give errors of 1.5 mm/s.
  static constexpr double kLeast_m_s = 0.008;
  static constexpr double kStroke_m_s = 0.05;
  /// So many intervals are shaking.
  static constexpr int kIntervals = 8;
  /// Each time, so much of the stiffness is left.
  static constexpr double kLeft = 0.7;
  static constexpr double kLeastShare = 0.1;

  /// A tick in contact, with the velocity of the grip and the unit normal of the surface.
  void see(const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& normal,
           double dt_s) noexcept {
    const double across_m_s = velocity_m_s.dot(normal);
    const double along_m_s = (velocity_m_s - across_m_s * normal).norm();
    slow_m_s_ += std::min(1.0, dt_s / kSlow_s) * (across_m_s - slow_m_s_);
    const double shaken_m_s = across_m_s - slow_m_s_;
    since_s_ += dt_s;
    most_m_s_ = std::max(most_m_s_, std::fabs(shaken_m_s));
    if (since_s_ > 0.5 / kSlowest_Hz || along_m_s > kStroke_m_s) intervals_ = 0;
    if ((shaken_m_s > 0) == rises_) return;
    rises_ = !rises_;
    const bool even = since_s_ >= 0.5 / kFastest_Hz && most_m_s_ >= kLeast_m_s;
    intervals_ = even ? intervals_ + 1 : 0;
    since_s_ = most_m_s_ = 0;
    if (intervals_ < kIntervals) return;
    intervals_ = 0;
    share_ = std::max(kLeastShare, kLeft * share_);
  }

  /// What is left of the stiffness: 1 until the grip was shaken. It does not rise again, because
  /// the lag is that of the device.
  double share() const noexcept { return share_; }

 private:
  static constexpr double kSlow_s = 0.02;  ///< 8 Hz

  double slow_m_s_ = 0;
  double most_m_s_ = 0;  // since the sign changed
  double since_s_ = 0;
  bool rises_ = false;
  int intervals_ = 0;
  double share_ = 1;
};

}  // namespace spidar
