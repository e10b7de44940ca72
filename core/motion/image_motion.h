// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motion of the picture, the paper's way to compute it from tracks, and how fast it can be.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/tracking/tracker.h"

namespace spidar {

/// Motion of the picture between two frames.
struct ImageMotion {
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  ///< image frame I: x right, y down
  /// Relative change of lengths per second: 0.5 is half as large again. Positive: it comes nearer.
  double growth_1_s = 0;
  double roll_rad_s = 0;  ///< rotation from x to y: clockwise as seen on the screen
  int tracked = 0;        ///< number of points from which it was measured
  /// Standard error of each coordinate of the velocity, of what changes from frame to frame; 0: not
  /// known.
  double noise_px_s = 0;
};

/// The paper's frame velocity (eq. 9–10): mean over all tracks of displacement / Δt. `interval_ns`
/// is the difference of the frames' running times and must be positive. Without tracks the velocity
/// is 0 and `tracked` is 0.
ImageMotion mean_motion(const std::vector<Track>& tracks, int64_t interval_ns);

/// Two frames count as at least so far apart: half a tick of the haptic loop. Timestamps that
/// differ by a rounding error are no time to divide a displacement by.
constexpr int64_t kLeastInterval_ns = 500'000;

/// `motion` over `interval_s` > 0, at most what can be seen of any: a displacement of the frame's
/// width, lengths twice or half as large, half a turn. Directions are kept. What is not finite is
/// no motion.
ImageMotion bound_motion(const ImageMotion& motion, int frame_width, double interval_s);

}  // namespace spidar
