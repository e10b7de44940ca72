// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

namespace spidar {

/// Force on the grip and torque about the grip's origin, both in the device frame D (right-handed:
/// x right, y up, z towards the viewer; origin at the workspace centre).
struct Wrench {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_Nm = Eigen::Vector3d::Zero();

  bool is_finite() const { return force_N.allFinite() && torque_Nm.allFinite(); }

  /// [force_N; torque_Nm]
  Eigen::Matrix<double, 6, 1> stacked() const {
    Eigen::Matrix<double, 6, 1> w;
    w << force_N, torque_Nm;
    return w;
  }
};

inline Wrench operator*(double s, const Wrench& w) {
  return {s * w.force_N, s * w.torque_Nm};
}
inline Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.force_N + b.force_N, a.torque_Nm + b.torque_Nm};
}
inline Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force_N - b.force_N, a.torque_Nm - b.torque_Nm};
}

inline Wrench interpolate(const Wrench& a, const Wrench& b, double s) {
  return a + s * (b - a);
}

}  // namespace spidar
