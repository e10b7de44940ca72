// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/motion_filter.h"

#include "core/force/motion_rendering.h"
#include "core/require.h"

namespace spidar {
namespace {

/// `x` is in px/s of the reference frame.
template <int N>
Eigen::Matrix<double, N, 1> steady(OneEuroFilter<N>& filter, const Eigen::Matrix<double, N, 1>& x,
                                   double interval_s, const FilterSettings& settings) {
  const auto y = filter.filter(x, interval_s, settings.min_cutoff_Hz, settings.beta_s_px);
  if (!x.isZero(0) || y.norm() > MotionFilter::kRest_px_s) return y;
  filter.reset(x);
  return x;
}

double steady(OneEuroFilter<1>& filter, double x_px_s, double interval_s,
              const FilterSettings& settings) {
  return steady<1>(filter, Eigen::Matrix<double, 1, 1>(x_px_s), interval_s, settings)[0];
}

}  // namespace

void validate(const FilterSettings& settings) {
  require_not_negative("min_cutoff_Hz", settings.min_cutoff_Hz);
  require_not_negative("beta_s_px", settings.beta_s_px);
}

ImageMotion MotionFilter::filter(const ImageMotion& motion, int frame_height, double interval_s,
                                 const FilterSettings& settings) {
  if (settings.min_cutoff_Hz == 0) {
    reset();
    return motion;
  }
  const double to_reference = kReferenceHeight_px / frame_height;
  ImageMotion steadier = motion;
  steadier.velocity_px_s =
      steady<2>(velocity_, to_reference * motion.velocity_px_s, interval_s, settings) /
      to_reference;
  steadier.growth_1_s =
      steady(growth_, kRim_px * motion.growth_1_s, interval_s, settings) / kRim_px;
  steadier.roll_rad_s = steady(roll_, kRim_px * motion.roll_rad_s, interval_s, settings) / kRim_px;
  const double fraction = velocity_.fraction();
  dead_zone_px_s_ =
      std::hypot((1 - fraction) * dead_zone_px_s_, fraction * to_reference * motion.dead_zone_px_s);
  steadier.dead_zone_px_s = dead_zone_px_s_ / to_reference;
  return steadier;
}

void MotionFilter::stop() {
  velocity_.reset(OneEuroFilter<2>::Vector::Zero());
  growth_.reset(OneEuroFilter<1>::Vector::Zero());
  roll_.reset(OneEuroFilter<1>::Vector::Zero());
  dead_zone_px_s_ = 0;
}

void MotionFilter::reset() {
  velocity_.reset();
  growth_.reset();
  roll_.reset();
  dead_zone_px_s_ = 0;
}

}  // namespace spidar
