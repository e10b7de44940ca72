// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Detects that nobody plays and nobody holds the grip, so that the motors can be switched off.
#pragma once

#include <Eigen/Core>

namespace spidar {

class IdleWatch {
 public:
  /// Time without a force or a movement after which the device is idle.
  static constexpr double kAfter_s = 300;
  /// If the grip has moved further than this, somebody holds it.
  static constexpr double kMove_m = 5e-3;

  /// To be called in each tick, `dt_s` after the last one. `wanted`: a force is wanted. Returns
  /// true once there has been neither a force nor a movement for kAfter_s, and false again as soon
  /// as there is either.
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
