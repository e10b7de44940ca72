// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Nobody plays and nobody holds the grip: the motors need not hold it either.
#pragma once

#include <Eigen/Core>

namespace spidar {

class IdleWatch {
 public:
  /// So long without anything to do.
  static constexpr double kAfter_s = 300;
  /// A grip that has moved further is held by somebody.
  static constexpr double kMove_m = 5e-3;

  /// A tick after `dt_s`. `wanted`: there is a force to be felt. True once there has been none for
  /// kAfter_s in which the grip has not moved; false again at once when either comes.
  bool idle(bool wanted, const Eigen::Vector3d& position_m, double dt_s) noexcept {
    if (wanted || (position_m - from_m_).norm() > kMove_m) {
      from_m_ = position_m;
      rested_s_ = 0;
    }
    rested_s_ += dt_s;
    return rested_s_ > kAfter_s;
  }

  void reset() noexcept { rested_s_ = 0; }

 private:
  Eigen::Vector3d from_m_ = Eigen::Vector3d::Zero();
  double rested_s_ = 0;
};

}  // namespace spidar
