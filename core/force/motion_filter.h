// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Smooths the motion before it becomes force.
#pragma once

#include "core/force/one_euro_filter.h"
#include "core/motion/image_motion.h"

namespace spidar {

/// Parameters of the 1 € filter, see one_euro_filter.h. A velocity that changes at a px/s² is
/// delayed by 1 / (2π (min_cutoff + β a)). The error from this delay is less than 1 / (2π β) at any
/// a: 2 px/s with the default β, which cannot be felt (AdaptiveController::kLeast_px_s).
/// docs/feeling.md compares other values.
struct FilterSettings {
  double min_cutoff_Hz = 1;  ///< finite and ≥ 0; 0 turns the filter off
  /// Hz for each px/s² of the reference frame, finite and ≥ 0.
  double beta_s_px = 0.08;
};

/// Throws std::invalid_argument when a value is out of range.
void validate(const FilterSettings& settings);

/// One 1 € filter each for velocity, growth and roll. All are filtered in px/s of the reference
/// frame, growth and roll as the speed at kRim_px, so that one β fits all. When nothing moves and
/// the filtered motion is slower than kRest_px_s, the result is exactly zero. The noise of the
/// velocity is reduced as the filter reduces it.
class MotionFilter {
 public:
  /// Filters the `motion` of a frame of `frame_height` pixels, `interval_s` > 0 after the previous
  /// frame. With min_cutoff_Hz = 0 it returns `motion` unchanged.
  ImageMotion filter(const ImageMotion& motion, int frame_height, double interval_s,
                     const FilterSettings& settings);

  /// Sets the filters to rest, as if the motion had been zero for a long time.
  void stop();

  /// After a cut or a seek: the next motion passes unchanged.
  void reset();

  static constexpr double kRest_px_s = 0.1;

 private:
  OneEuroFilter<2> velocity_;
  OneEuroFilter<1> growth_;
  OneEuroFilter<1> roll_;
  double noise_px_s_ = 0;
};

}  // namespace spidar
