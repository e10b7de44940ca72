// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The searches behind the pose solver: a pose that fits measured string lengths.
#pragma once

#include "core/grip/length_model.h"
#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"

namespace spidar {

/// The result of a search.
struct PoseFit {
  Pose pose;
  double residual_m = 0;  ///< root mean square length error of the strings that were used
  int iterations = 0;     ///< linearised problems solved
  bool converged = false;
};

/// Least squares over the string lengths. `left_out` and `also` name strings whose lengths are not
/// used, −1 for none.
class PoseFitter {
 public:
  explicit PoseFitter(const StringGeometry& geometry) : model_(geometry) {}

  /// Up to four Gauss–Newton steps; for a start within some millimetres.
  PoseFit gauss_newton(const StringVector& lengths_m, const Pose& start, int left_out,
                       int also = -1) const noexcept;

  /// Converges to a local minimum; for a start within some centimetres.
  PoseFit levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                              int left_out) const noexcept;

  /// levenberg_marquardt() from `start` and, if that does not fit, from 14 turned poses at the
  /// centre.
  PoseFit search(const StringVector& lengths_m, const Pose& start) const noexcept;

  /// Near a singular J, the poses on both sides of the singular one have nearly the same lengths;
  /// they differ by a turn in the direction of the smallest singular value. Returns the better
  /// fitting minimum that lies beside `fit` in this direction; `converged` is false if there is
  /// none.
  PoseFit beside(const StringVector& lengths_m, const PoseFit& fit, int left_out) const noexcept;

  const LengthModel& model() const noexcept { return model_; }

 private:
  LengthModel model_;
};

}  // namespace spidar
