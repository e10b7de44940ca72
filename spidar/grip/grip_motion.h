// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "core/history.h"

namespace spidar {

/// 1 − exp(−x) for x = `dt_s` / `time_s`: the step response of a first-order low-pass. The third-
/// order series is 0.3 % too small at x = 0.5, but cheaper, and a tick needs five values.
inline double fraction_passed(double dt_s, double time_s) noexcept {
  if (!(time_s > 0)) return 1;
  const double x = dt_s / time_s;
  return 1 - 1 / (1 + x * (1 + x * (0.5 + x / 6)));
}

struct GripVelocity {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// Estimates the velocity of the grip from poses and the times at which they were read.
///
/// velocity() is a first-order low-pass of the differences, exact for any intervals, and lags the
/// newest pose by kLag_s. For coordinates with independent errors of standard deviation σ, the
/// error of the velocity is 0.25 σ per tick; an encoder step of 20 µm (σ = 6 µm) gives 1.5 mm/s.
///
/// velocity_in() fits a parabola to the poses of the last kFitted_ns by least squares. No single
/// interval dominates, because after a late tick an interval may last only 0.05 ms. The error of
/// poses and the possible acceleration of a grip limit how far the result departs from velocity()
/// when poses are few or close in time; without poses, the result is velocity().
class GripMotion {
 public:
  static constexpr double kCutoff_Hz = 60;
  /// Half a tick, which is the lag of the difference, and the time constant of the low-pass.
  static constexpr double kLag_s = 0.5e-3 + 1 / (2 * M_PI * kCutoff_Hz);

  /// Adds the pose of the grip at `at_ns`. Ignored unless `at_ns` is later than the last time.
  void update(const Pose& pose, int64_t at_ns) noexcept {
    if (!poses_.empty()) {
      const double dt_s = 1e-9 * static_cast<double>(at_ns - poses_[0].at_ns);
      if (!(dt_s > 0)) return;
      const double fraction = fraction_passed(dt_s, 1 / (2 * M_PI * kCutoff_Hz));
      velocity_.linear_m_s +=
          fraction * ((pose.position_m - poses_[0].pose.position_m) / dt_s - velocity_.linear_m_s);
      velocity_.angular_rad_s +=
          fraction * (turn_rad(poses_[0].pose, pose) / dt_s - velocity_.angular_rad_s);
    }
    // Poses in a burst replace each other, so that they do not displace the poses before the burst.
    if (poses_.size() > 1 && at_ns - poses_[1].at_ns < kApart_ns) {
      poses_[0] = {pose, at_ns};
    } else {
      poses_.add({pose, at_ns});
    }
  }

  /// Call this when the pose is unknown: the velocity is zero until there are two poses again.
  void reset() noexcept { *this = {}; }

  bool is_known() const noexcept { return !poses_.empty(); }
  const GripVelocity& velocity() const noexcept { return velocity_; }

  /// Returns the pose that a grip at `pose` has `ahead_s` later, at the present velocity.
  Pose pose_in(const Pose& pose, double ahead_s) const noexcept {
    Eigen::Quaterniond turn;
    turn.w() = 1;
    turn.vec() = 0.5 * ahead_s * velocity().angular_rad_s;
    return {pose.position_m + ahead_s * velocity().linear_m_s,
            (turn * pose.orientation).normalized()};
  }

  /// Extrapolates the velocity to `ahead_s` after the newest pose, with the poses' acceleration.
  GripVelocity velocity_in(double ahead_s) const noexcept {
    // The normal equations of way = c + a t + b h, where h is t²/2, and way is the distance of a
    // pose from the one that velocity_ predicts. Subtracting the means below eliminates c.
    double n = 0, t_sum = 0, h_sum = 0, tt = 0, th = 0, hh = 0;
    Six way_sum = Six::Zero(), t_way = Six::Zero(), h_way = Six::Zero();
    for (size_t age = 0; age < poses_.size(); ++age) {
      const int64_t before_ns = poses_[0].at_ns - poses_[age].at_ns;
      if (before_ns > kFitted_ns) break;
      const double t = -1e-9 * static_cast<double>(before_ns), h = 0.5 * t * t;
      Six way;
      way << poses_[age].pose.position_m - poses_[0].pose.position_m - t * velocity_.linear_m_s,
          turn_rad(poses_[0].pose, poses_[age].pose) - t * velocity_.angular_rad_s;
      n += 1, t_sum += t, h_sum += h, tt += t * t, th += t * h, hh += h * h;
      way_sum += way, t_way += t * way, h_way += h * way;
    }
    if (!(n > 0)) return velocity_;
    constexpr double kOfVelocity_s = kPoseError_m / kMax_m_s;
    constexpr double kOfAcceleration_s2 = kPoseError_m / kMax_m_s2;
    tt += kOfVelocity_s * kOfVelocity_s - t_sum * t_sum / n;
    th -= t_sum * h_sum / n;
    hh += kOfAcceleration_s2 * kOfAcceleration_s2 - h_sum * h_sum / n;
    t_way -= t_sum / n * way_sum;
    h_way -= h_sum / n * way_sum;
    const double determinant = tt * hh - th * th;
    const Six then = (hh * t_way - th * h_way + ahead_s * (tt * h_way - th * t_way)) / determinant;
    return {velocity_.linear_m_s + then.head<3>(), velocity_.angular_rad_s + then.tail<3>()};
  }

  /// The rotation vector, which for the small angles of a few ticks is twice the vector part.
  static Eigen::Vector3d turn_rad(const Pose& from, const Pose& to) noexcept {
    const Eigen::Quaterniond turn = to.orientation * from.orientation.conjugate();
    return (turn.w() < 0 ? -2.0 : 2.0) * turn.vec();
  }

 private:
  using Six = Eigen::Matrix<double, 6, 1>;
  struct TimedPose {
    Pose pose;
    int64_t at_ns = 0;
  };

  /// The time of seven poses, if all ticks are on time.
  static constexpr int64_t kFitted_ns = 6'500'000;
  static constexpr int64_t kApart_ns =
      500'000;  ///< between a pose and the next but one, so that kPoses suffice
  static constexpr size_t kPoses = 2 * kFitted_ns / kApart_ns;
  /// Two encoder steps, or what a hand at 0.5 m/s moves in 0.1 ms, the error of a reading's time.
  static constexpr double kPoseError_m = 50e-6;
  /// The largest acceleration, of 3 N on kLightestGrip_kg, which limits how far the velocity
  /// departs from velocity() within its lag. Rotations have that limit at the grip's radius.
  static constexpr double kMax_m_s2 = 90;
  static constexpr double kMax_m_s = 0.3;

  History<TimedPose, kPoses> poses_;
  GripVelocity velocity_;
};

}  // namespace spidar
