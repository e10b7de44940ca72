// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The searches behind the pose solver: a pose that fits measured string lengths.
#pragma once

#include "core/grip/length_model.h"
#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"

namespace spidar {

/// Where a search ended.
struct PoseFit {
  Pose pose;
  double residual_m = 0;  ///< root mean square length error of the strings that were used
  int iterations = 0;     ///< linearised problems solved
  bool converged = false;
};

/// Least squares over the lengths of all strings, or of all but `left_out` (−1: of all) and `also`.
class PoseFitter {
 public:
  explicit PoseFitter(const StringGeometry& geometry) : model_(geometry) {}

  /// Up to four Gauss–Newton steps from a start some millimetres off.
  PoseFit gauss_newton(const StringVector& lengths_m, const Pose& start, int left_out,
                       int also = -1) const noexcept;

  /// From a start some centimetres off, to the bottom of the minimum it leads to.
  PoseFit levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                              int left_out) const noexcept;

  /// levenberg_marquardt() from `start`, and where that does not fit from 14 turned poses at the
  /// centre.
  PoseFit search(const StringVector& lengths_m, const Pose& start) const noexcept;

  /// Where J is nearly singular two poses on either side of the singular one have nearly the same
  /// lengths; they differ by a turn in the direction of the smallest singular value. Returns the
  /// better fitting minimum beside `fit` in this direction, not converged when there is none.
  PoseFit beside(const StringVector& lengths_m, const PoseFit& fit, int left_out) const noexcept;

  const LengthModel& model() const noexcept { return model_; }

 private:
  LengthModel model_;
};

}  // namespace spidar
