// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/motion_bounds.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

double bounded(double value, double bound) {
  return std::isfinite(value) ? std::clamp(value, -bound, bound) : 0;
}

}  // namespace

ImageMotion bound_motion(const ImageMotion& motion, int frame_width, double interval_s) {
  const double frames_1_s = 1 / interval_s;
  ImageMotion possible = motion;
  const double speed_px_s = motion.velocity_px_s.stableNorm();
  const double fastest_px_s = frame_width * frames_1_s;
  if (!std::isfinite(speed_px_s)) {
    possible.velocity_px_s.setZero();
  } else if (speed_px_s > fastest_px_s) {
    possible.velocity_px_s *= fastest_px_s / speed_px_s;
  }
  possible.growth_1_s = bounded(motion.growth_1_s, frames_1_s);
  possible.roll_rad_s = bounded(motion.roll_rad_s, M_PI * frames_1_s);
  return possible;
}

}  // namespace spidar
