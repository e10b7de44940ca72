// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/grip/string_geometry.h"

namespace spidar {

/// A small motion of the grip in D: a translation in metres, and a rotation vector times the grip
/// radius, also in metres.
using Twist = Eigen::Matrix<double, 6, 1>;

/// H s = g for the step s that brings the lengths of the linearised model closest to the measured
/// ones: H = Σ wᵢ Jᵢ Jᵢᵀ, g = −Σ wᵢ Jᵢ rᵢ, with Jᵢ the derivative of the length (minus a column of
/// the structure matrix) and rᵢ length minus measured length.
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> H;
  Twist g;
  double cost_m2;  ///< Σ wᵢ rᵢ²
};

struct PoseFit {
  Pose pose;
  double residual_m = 0;  ///< RMS length error of the strings that were used
  int iterations = 0;     ///< the number of linearised problems
  bool converged = false;
};

/// Finds the pose that fits the measured string lengths best, by least squares. `left_out` and
/// `also` name strings whose lengths are not used, −1 for none.
class PoseFitter {
 public:
  explicit PoseFitter(const StringGeometry& geometry);

  /// Makes up to four Gauss–Newton steps; for a start within some millimetres.
  PoseFit gauss_newton(const StringVector& lengths_m, const Pose& start, int left_out,
                       int also = -1) const noexcept;

  /// Converges to a local minimum; for a start within some centimetres.
  PoseFit levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                              int left_out) const noexcept;

  /// Runs levenberg_marquardt() from `start` and then, if needed, from 14 turned poses at the
  /// centre.
  PoseFit search(const StringVector& lengths_m, const Pose& start) const noexcept;

  /// Near a singular J, the poses on both sides of the singular one have nearly the same lengths;
  /// they differ by a rotation in the direction of the smallest singular value. Returns the better
  /// fitting minimum beside `fit` in this direction; `converged` is false if there is none.
  PoseFit beside(const StringVector& lengths_m, const PoseFit& fit, int left_out) const noexcept;

  Pose moved(const Pose& pose, const Twist& twist) const noexcept;

  /// The twist t with moved(from, t) = to.
  Twist twist(const Pose& from, const Pose& to) const noexcept;

 private:
  /// `weight` is 1 for strings that count and 0 for the others.
  void linearise(const Pose& pose, const StringVector& length_m, const StringVector& weight,
                 NormalEquations& equations) const noexcept;

  Eigen::Matrix<double, 3, kMaxStrings> exit_m_, grip_m_;  ///< one column per string
  int count_;
  double radius_m_;
};

}  // namespace spidar
