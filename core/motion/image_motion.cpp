// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/image_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace spidar {

ImageMotion mean_motion(const std::vector<Track>& tracks, int64_t interval_ns) {
  if (interval_ns <= 0) {
    throw std::invalid_argument("mean_motion: the interval must be positive, got " +
                                std::to_string(interval_ns) + " ns");
  }
  ImageMotion motion;
  if (tracks.empty()) return motion;
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  for (const Track& track : tracks) {
    sum_px.x() += static_cast<double>(track.to.x_px) - static_cast<double>(track.from.x_px);
    sum_px.y() += static_cast<double>(track.to.y_px) - static_cast<double>(track.from.y_px);
  }
  const double interval_s = static_cast<double>(interval_ns) * 1e-9;
  motion.tracked = static_cast<int>(tracks.size());
  motion.velocity_px_s = sum_px / static_cast<double>(tracks.size()) / interval_s;
  return motion;
}

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
