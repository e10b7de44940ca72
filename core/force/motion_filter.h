// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/motion/image_motion.h"

namespace spidar {

/// The "1 €" filter of a vector (Casiez, Roussel and Vogel: 1 € Filter: A Simple Speed-based
/// Low-pass Filter for Noisy Input in Interactive Systems, CHI 2012, Algorithm 1 and 2): a
/// first-order low-pass whose cutoff rises with the rate of change, fc = fc_min + β |dx/dt|. Slow
/// changes are smoothed, fast ones hardly delayed. |dx/dt| is that of the whole vector, so that the
/// result does not depend on the directions of the axes. Unlike in the paper, the magnitude of the
/// rate of change is low-passed, not the vector: in a motion to and fro, opposite directions would
/// cancel, and the cutoff would fall when it must be high.
///
/// Samples may be any time apart: the smoothing factor is that of the backward Euler step, 1 / (1 +
/// 1 / (2π fc Δt)). A ramp is delayed by 1 / (2π fc), whatever Δt.
template <int N>
class OneEuroFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  static constexpr double kRateCutoff_Hz = 1;

  /// Filters a value; the first one after reset() passes unchanged. `interval_s` > 0 is the time
  /// since the previous value, `min_cutoff_Hz` > 0, `beta` ≥ 0 in Hz for a unit of x a second.
  Vector filter(const Vector& x, double interval_s, double min_cutoff_Hz, double beta) {
    if (!started_) {
      reset(x);
      return x;
    }
    const double rate = (x - value_).norm() / interval_s;
    rate_ += smoothing(kRateCutoff_Hz, interval_s) * (rate - rate_);
    const double cutoff_Hz = min_cutoff_Hz + beta * rate_;
    fraction_ = smoothing(cutoff_Hz, interval_s);
    value_ += fraction_ * (x - value_);
    return value_;
  }

  /// The fraction of the newest value in the last result, 0 … 1: result += fraction · (value −
  /// result). If the values have independent noise of variance v, the noise of the result has the
  /// variance (1 − fraction)² u + fraction² v, where u is that of the previous result.
  double fraction() const { return fraction_; }

  void reset(const Vector& x) {
    value_ = x;
    rate_ = 0;
    fraction_ = 1;
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
  double rate_ = 0;  ///< the magnitude of the rate of change
  double fraction_ = 1;
  bool started_ = false;
};

/// Parameters of the OneEuroFilter. A velocity that changes at a px/s² is delayed by 1 / (2π
/// (min_cutoff + β a)). The error from this delay is less than 1 / (2π β) where a is constant, 2
/// px/s with the default β, which cannot be felt (DeadZone::kUnknownError_px_s). When the velocity
/// oscillates, the low-passed rate is at least 0.45 of the largest a: the error is less than 0.36 /
/// β, 4.5 px/s. docs/feeling.md compares other values.
struct FilterSettings {
  double min_cutoff_Hz = 1;  ///< finite and ≥ 0; 0 turns the filter off
  double beta_s_px = 0.08;   ///< Hz for each px/s² of the reference frame, finite and ≥ 0
};

/// Throws std::invalid_argument when a value is out of range.
void validate(const FilterSettings& settings);

/// Smooths the motion before it becomes force, with one 1 € filter each for velocity, growth and
/// roll. All are filtered in px/s of the reference frame, growth and roll as the speed at kRim_px,
/// so that one β fits all. When nothing moves and the filtered motion is slower than kRest_px_s,
/// the result is exactly zero. The dead zone shrinks as the noise of the velocity does.
class MotionFilter {
 public:
  /// Filters the `motion` of a frame of `frame_height` pixels, `interval_s` > 0 after the previous
  /// frame. With min_cutoff_Hz = 0 this returns `motion` unchanged.
  ImageMotion filter(const ImageMotion& motion, int frame_height, double interval_s,
                     const FilterSettings& settings);

  /// Stops the filters, as if the motion had been zero for a long time.
  void stop();

  /// Call this after a cut or a seek: the next motion passes unchanged.
  void reset();

  static constexpr double kRest_px_s = 0.1;

 private:
  OneEuroFilter<2> velocity_;
  OneEuroFilter<1> growth_;
  OneEuroFilter<1> roll_;
  double dead_zone_px_s_ = 0;
};

}  // namespace spidar
