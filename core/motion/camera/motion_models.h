// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Models of how a plane, or something like a plane, moves from one frame to the next.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// The model hierarchy: each model contains the ones before it.
enum class ModelKind { kStill, kTranslation, kSimilarity, kAffine, kHomography };
constexpr int kModelKinds = 5;

/// Free parameters: 0, 2, 4, 6, 8.
constexpr int parameters(ModelKind kind) {
  return 2 * static_cast<int>(kind);
}
/// "still", "translation", "similarity", "affine", "homography".
const char* to_string(ModelKind kind);

/// A displacement from one frame to the next, relative to the centre of the frame.
struct Displacement {
  /// Its position in the first frame, from the frame's centre; x right, y down.
  Eigen::Vector2d at_px;
  Eigen::Vector2d moved_px;
};

/// No more are used of a frame, which bounds its cost.
constexpr size_t kMostDisplacements = 512;

/// p ↦ (p + A p + t) / (1 + h·p), p from the centre of the frame. Parameters that a kind does not
/// have are exactly zero.
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
  /// Rotation at the centre from x to y: clockwise as seen on the screen.
  double roll_rad() const;
};

/// Model of the background in one frame, and its quality.
struct Background {
  MotionModel model;
  double sigma_px = 0;  ///< noise of a displacement, each coordinate
  double coverage =
      1;  ///< fraction of the picture's votes that agree with the model; 0: hardly any
  /// False where there is texture all over the picture and hardly any of it agrees with the best
  /// model, where what agrees may be an object's, and where there are few votes because most of the
  /// picture is new: how the camera moves is unknown, and with it what moves by itself. The model
  /// is 'still' then, and `coverage` 0.
  bool is_known = true;
  bool is_of_areas = false;  ///< areas of several blocks showed it, of which few had texture
};

/// Least squares: minimises Σ w |moved − displacement(at)|², w ≥ 0, one weight for each point.
/// Returns nothing when the points do not determine the model: too few, in one position, or on one
/// line. The homography is found by at most four Gauss–Newton steps from the affine solution,
/// because the perspective between successive frames is small.
std::optional<MotionModel> fit_model(ModelKind kind, const std::vector<Displacement>& points,
                                     const std::vector<double>& weights);

}  // namespace spidar
