// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Less jitter where it is seen, less delay where that is felt.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace spidar {

/// The "1 €" filter of a vector (Casiez, Roussel and Vogel: 1 € Filter: A Simple Speed-based
/// Low-pass Filter for Noisy Input in Interactive Systems, CHI 2012, Algorithm 1 and 2): a
/// first-order low-pass whose cutoff rises with the rate of change, fc = fc_min + β |dx/dt|. Slow
/// changes are smoothed, fast ones hardly delayed. Here |dx/dt| is that of the whole vector, so
/// that the filter does not depend on how the axes lie.
///
/// Samples may be any time apart: the smoothing factor is that of the backward Euler step,
/// 1 / (1 + 1 / (2π fc Δt)). A ramp is delayed by 1 / (2π fc), whatever Δt.
template <int N>
class OneEuroFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  /// Cutoff of the rate of change, as in the paper.
  static constexpr double kRateCutoff_Hz = 1;

  /// The first value after reset() passes as it is. `interval_s` > 0 since the value before,
  /// `min_cutoff_Hz` > 0, `beta` ≥ 0 in Hz for a unit of x a second.
  Vector filter(const Vector& x, double interval_s, double min_cutoff_Hz, double beta) {
    if (!started_) {
      restart_at(x);
      return x;
    }
    const Vector rate = (x - value_) / interval_s;
    rate_ += smoothing(kRateCutoff_Hz, interval_s) * (rate - rate_);
    const double cutoff_Hz = min_cutoff_Hz + beta * rate_.norm();
    share_ = smoothing(cutoff_Hz, interval_s);
    value_ += share_ * (x - value_);
    return value_;
  }

  /// Share of the newest value in the last result, 0 … 1: result += share · (value − result). If
  /// the values have independent noise of variance v, the noise of the result has the variance
  /// (1 − share)² u + share² v, where u is that of the result before.
  double share() const { return share_; }

  /// Starts anew with `x` as the first value.
  void restart_at(const Vector& x) {
    value_ = x;
    rate_.setZero();
    share_ = 1;
    started_ = true;
  }

  void reset() { started_ = false; }

 private:
  static double smoothing(double cutoff_Hz, double interval_s) {
    constexpr double kTwoPi = 6.28318530717958647692;
    const double turns = kTwoPi * cutoff_Hz * interval_s;
    return turns / (1 + turns);
  }

  Vector value_ = Vector::Zero();
  Vector rate_ = Vector::Zero();
  double share_ = 1;
  bool started_ = false;
};

}  // namespace spidar
