// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How a plane, or what looks like one, moves from one frame to the next.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// The rungs of the ladder: each one contains those before it.
enum class ModelKind { kStill, kTranslation, kSimilarity, kAffine, kHomography };
constexpr int kModelKinds = 5;

/// Free parameters: 0, 2, 4, 6, 8.
constexpr int parameters(ModelKind kind) {
  return 2 * static_cast<int>(kind);
}
/// Points that determine it, each one gives two equations: 0 … 4.
constexpr int least_points(ModelKind kind) {
  return static_cast<int>(kind);
}
/// "still", "translation", "similarity", "affine", "homography".
SPIDAR_API const char* to_string(ModelKind kind);

/// A track about the centre of the frame.
struct Displacement {
  uint32_t id = 0;           ///< of the track
  Eigen::Vector2d at_px;     ///< where it came from, from the frame's centre; x right, y down
  Eigen::Vector2d moved_px;  ///< to the frame after
};

/// The tracks of a frame of `width` × `height` pixels; of more than kMostDisplacements every k-th,
/// which bounds what a frame costs.
SPIDAR_API void displacements(const std::vector<Track>& tracks, int width, int height,
                              std::vector<Displacement>& result);
constexpr size_t kMostDisplacements = 512;

/// p ↦ (p + A p + t) / (1 + h·p), p from the centre of the frame. What a kind does not have is
/// exactly zero.
struct MotionModel {
  ModelKind kind = ModelKind::kStill;
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();          ///< t, displacement of the centre
  Eigen::Matrix2d linear = Eigen::Matrix2d::Zero();            ///< A
  Eigen::Vector2d perspective_1_px = Eigen::Vector2d::Zero();  ///< h

  Eigen::Vector2d displacement_px(const Eigen::Vector2d& at_px) const {
    const Eigen::Vector2d moved_px = shift_px + linear * at_px;
    if (kind != ModelKind::kHomography) return moved_px;
    return (at_px + moved_px) / (1 + perspective_1_px.dot(at_px)) - at_px;
  }
  /// Relative change of lengths at the centre; 0.01 is one per cent larger.
  double growth() const { return linear.trace() / 2; }
  /// Turn at the centre from x to y: clockwise as seen on the screen.
  SPIDAR_API double roll_rad() const;
};

/// Which model the background has in one frame, and how well.
struct Background {
  MotionModel model;
  double sigma_px = 0;  ///< noise of a displacement, each coordinate
  double coverage = 1;  ///< share of the picture's votes that speak for the model
};

/// Least squares: minimises Σ w |moved − displacement(at)|², w ≥ 0, one weight a point.
/// Nothing when the points do not determine the model: too few, in one place, on one line.
/// The homography is found by Gauss–Newton from the affine solution, a fixed number of steps:
/// from one frame to the next the perspective is small.
SPIDAR_API std::optional<MotionModel> fit_model(ModelKind kind,
                                                const std::vector<Displacement>& points,
                                                const std::vector<double>& weights);

}  // namespace spidar
