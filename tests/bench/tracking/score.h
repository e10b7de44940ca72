// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Speed and error of one pipeline.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/motion/motion_estimator.h"
#include "core/tracking/tracker.h"
#include "tests/support/known_motion.h"

namespace spidar::bench {

/// Lengths are compared at this width of the frame, so that sizes can be.
constexpr double kReferenceWidth_px = 640;

/// Over the frames of one film, or of several. Velocities are px a frame at kReferenceWidth_px.
struct Score {
  std::vector<double> ms;  ///< tracks and motion of a frame

  std::vector<double> epe_px;  ///< end point error of tracks, px of the frame
  long looked_for = 0;
  long lost = 0;
  long wrong = 0;  ///< tracks with an error above 1 px at kReferenceWidth_px

  // Frames with an object in view.
  std::vector<double> mean_error;    ///< |A − v|, A: the mean of eq. 10, v: true velocity
  std::vector<double> object_error;  ///< |B − v|, B: the dominant object against the background
  int missed = 0;                    ///< frames in which there is no B; their error is |v|

  // Frames without an object at all.
  int without_object = 0;
  int ghosts = 0;  ///< frames in which there is a B all the same

  // All frames: the largest motion.
  double largest_mean = 0;
  double largest_object = 0;

  /// `truth` gives the displacement of a place, px, or nothing where it is unknown; `unit` is
  /// kReferenceWidth_px / width.
  void add_tracks(
      const TrackedFrame& tracked, int were_looked_for,
      const std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d&)>& truth,
      double unit);
  /// A of a frame with the true motion of `film`, and B, if there is a `scene` of motion=object.
  void add_motion(const test::Film& film, int frame, const TrackedFrame& tracked,
                  const MeasuredFrame* scene, double interval_s);

  void add(const Score& other);
};

}  // namespace spidar::bench
