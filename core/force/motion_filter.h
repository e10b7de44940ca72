// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Steadier motion, before it becomes force.
#pragma once

#include "core/api.h"
#include "core/force/one_euro_filter.h"
#include "core/motion/image_motion.h"

namespace spidar {

/// Of the 1 € filter, see one_euro_filter.h. A velocity that changes by a px/s² is late by 1 / (2π
/// (min_cutoff + β a)), an error of less than 1 / (2π β) however fast it changes: with the default
/// β 2 px/s, less than is felt (AdaptiveController::kLeast_px_s). docs/feeling.md has what other
/// values cost and give.
struct FilterSettings {
  double min_cutoff_Hz = 1;  ///< finite and ≥ 0; 0 is no filter at all
  /// Hz for each px/s² of the reference frame, finite and ≥ 0.
  double beta_s_px = 0.08;
};

/// Throws std::invalid_argument when a value is out of range.
SPIDAR_API void validate(const FilterSettings& settings);

/// A 1 € filter each for velocity, growth and roll, all in px/s of the reference frame so that one
/// β does for all: growth and roll by the speed at kRim_px. Where nothing moves any more, and what
/// is left is slower than kRest_px_s, the result is exactly zero. The noise
/// of the velocity is that of what is left of it.
class SPIDAR_API MotionFilter {
 public:
  /// `motion` of a frame of `frame_height` pixels, `interval_s` > 0 after the frame before. With no
  /// cutoff the very same motion.
  ImageMotion filter(const ImageMotion& motion, int frame_height, double interval_s,
                     const FilterSettings& settings);

  /// Rest: as if a motion of zero had passed for long.
  void stop();

  /// A cut, a seek: the next motion passes as it is.
  void reset();

  static constexpr double kRest_px_s = 0.1;

 private:
  OneEuroFilter<2> velocity_;
  OneEuroFilter<1> growth_;
  OneEuroFilter<1> roll_;
  double noise_px_s_ = 0;
};

}  // namespace spidar
