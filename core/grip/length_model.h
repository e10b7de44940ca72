// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// String lengths at a pose, and the normal equations of fitting them.
#pragma once

#include <cmath>

#include "core/grip/row.h"
#include "core/grip/string_geometry.h"

namespace spidar {

/// A small motion of the grip in D: a translation in metres, and a rotation vector times the grip
/// radius, also in metres.
using Twist = Eigen::Matrix<double, 6, 1>;

/// H s = g for the step s that brings the lengths of the linearised model closest to the measured
/// ones: H = Σ wᵢ Jᵢ Jᵢᵀ, g = −Σ wᵢ Jᵢ rᵢ, with Jᵢ the derivative of the length (minus a column of
/// the structure matrix) and rᵢ length minus measured length.
struct NormalEquations {
  alignas(16) Row H[8];  ///< upper triangle, rows and columns 0 … 5
  alignas(16) Row g;
  double cost_m2;  ///< Σ wᵢ rᵢ²
};

/// The geometry of the strings, stored so that one vector operation handles two strings.
struct LengthModel {
  alignas(16) Row exit_m[3];
  alignas(16) Row grip_m[3];
  int count;
  double radius_m;

  explicit LengthModel(const StringGeometry& geometry)
      : exit_m{}, grip_m{}, count(geometry.count), radius_m(geometry.grip_radius_m()) {
    for (int i = 0; i < kMaxStrings; ++i)
      for (int k = 0; k < 3; ++k) {
        // Unused strings get a length, so that nothing is divided by zero.
        exit_m[k][i] = i < count ? geometry.exit_m[static_cast<size_t>(i)][k] : 1.0;
        grip_m[k][i] = i < count ? geometry.grip_m[static_cast<size_t>(i)][k] : 0.0;
      }
  }

  /// `weight` is 1 for strings that count and 0 for those that do not.
  void linearise(const Pose& pose, const double* length_m, const double* weight,
                 NormalEquations& equations) const noexcept {
    constexpr double kNoLength = 1e-12;
    const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
    const Eigen::Vector3d& x = pose.position_m;
    const double to_scaled = 1 / radius_m;
    alignas(16) Row string[8];  // J (6), weighted residual, 0
    Pair cost = {};
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) {
      Pair arm[3], unit[3];
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) {
        arm[k] = R(k, 0) * pair(grip_m[0], p) + R(k, 1) * pair(grip_m[1], p) +
                 R(k, 2) * pair(grip_m[2], p);
        unit[k] = pair(exit_m[k], p) - x[k] - arm[k];
      }
      const Pair square = unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2];
      const Pair length = {std::sqrt(square[0]), std::sqrt(square[1])};
      const Pair w = pair(weight, p);
      const Pair scale = w / larger(length, Pair{kNoLength, kNoLength});
      const Pair r = w * (length - pair(length_m, p));
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) unit[k] *= scale;
      const Pair t0 = (arm[1] * unit[2] - arm[2] * unit[1]) * to_scaled;
      const Pair t1 = (arm[2] * unit[0] - arm[0] * unit[2]) * to_scaled;
      const Pair t2 = (arm[0] * unit[1] - arm[1] * unit[0]) * to_scaled;
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i) {
        pair(string[2 * p + i], 0) = Pair{unit[0][i], unit[1][i]};
        pair(string[2 * p + i], 1) = Pair{unit[2][i], t0[i]};
        pair(string[2 * p + i], 2) = Pair{t1[i], t2[i]};
        pair(string[2 * p + i], 3) = Pair{r[i], 0};
      }
      cost += r * r;
    }
    equations.cost_m2 = cost[0] + cost[1];
    multiply(string, equations);
  }

  /// Root mean square length error of the strings that count.
  double rms_m(double cost_m2, int strings) const noexcept {
    return std::sqrt(cost_m2 / strings);
  }

  Pose moved(const Pose& pose, const Twist& twist) const noexcept {
    Pose result;
    result.position_m = pose.position_m + twist.head<3>();
    // Cayley's map: the rotation vector to second order, without trigonometry.
    const Eigen::Vector3d half = twist.tail<3>() * (0.5 / radius_m);
    const Eigen::Quaterniond turn(1, half.x(), half.y(), half.z());
    result.orientation = (turn * pose.orientation).normalized();
    return result;
  }

  /// The twist t with moved(from, t) = to.
  Twist twist(const Pose& from, const Pose& to) const noexcept {
    const Eigen::Quaterniond turn = to.orientation * from.orientation.conjugate();
    Twist result;
    result << to.position_m - from.position_m, turn.vec() * (2 * radius_m / turn.w());
    return result;
  }

 private:
  // Row i of `string` is [Jᵢ, rᵢ, 0]. The sum of the outer products of Jᵢ with the row has H in its
  // first six columns and −g in the seventh. Rows 2j and 2j + 1 are made together.
  static void multiply(const Row* string, NormalEquations& equations) noexcept {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      Pair upper[kPairs] = {}, lower[kPairs] = {};
#pragma GCC unroll 8
      for (int i = 0; i < 8; ++i)
#pragma GCC unroll 4
        for (int p = j; p < kPairs; ++p) {
          upper[p] += pair(string[i], p) * string[i][2 * j];
          lower[p] += pair(string[i], p) * string[i][2 * j + 1];
        }
#pragma GCC unroll 3
      for (int p = j; p < 3; ++p) {
        pair(equations.H[2 * j], p) = upper[p];
        pair(equations.H[2 * j + 1], p) = lower[p];
      }
      // J = −unit: the two signs cancel in g = −Σ J r.
      pair(equations.g, j) = Pair{upper[3][0], lower[3][0]};
    }
  }
};

}  // namespace spidar
