// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Models of the motion of a scene that is nearly a plane from one frame to the next, and their fit
/// to displacements some of which are outliers.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// The model hierarchy: each model contains the ones before it.
enum class ModelKind { kStill, kTranslation, kSimilarity, kAffine, kHomography };
constexpr int kModelKinds = 5;

constexpr int parameters(ModelKind kind) {
  constexpr int kFree[kModelKinds] = {0, 2, 4, 6, 8};
  return kFree[static_cast<int>(kind)];
}
const char* to_string(ModelKind kind);

/// A displacement from one frame to the next, relative to the centre of the frame.
struct Displacement {
  /// The position in the first frame, relative to its centre; x right, y down.
  Eigen::Vector2d at_px;
  Eigen::Vector2d moved_px;
};

/// The maximum number of displacements in a frame, which bounds the computing time.
constexpr size_t kMaxDisplacements = 512;

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
  /// Rotation at the centre from x to y: clockwise on the screen.
  double roll_rad() const;
};

/// Model of the background in one frame, and its quality.
struct Background {
  MotionModel model;
  double sigma_px = 0;  ///< noise of a displacement, each coordinate
  double coverage =
      1;  ///< fraction of the picture's votes that agree with the model; 0: hardly any
  /// False in three cases: there is texture all over the picture and hardly any of it agrees with
  /// the best model; the votes that agree may be an object's; there are few votes because most of
  /// the picture is new. The motion of the camera and of objects is then unknown, the model is
  /// 'still', and `coverage` 0.
  bool is_known = true;
  /// Few of the blocks with texture showed the motion: it was found from coarse blocks, or from the
  /// border beside a large object.
  bool is_of_few = false;
};

struct WeightedDisplacements {
  std::vector<Displacement> points;
  std::vector<double> weights;  ///< ≥ 0, one for each point
  double sigma_px = 1;          ///< noise of a displacement, each coordinate, > 0
};

/// The number of tried pairs of points. When half of the votes belong to the background, one pair
/// in four has no outlier; the probability that all tried pairs have one is 1e-5.
constexpr size_t kMaxTries = 40;

/// The noise of a displacement where it has not been measured, each coordinate, px of the field's
/// picture: that of blocks with much texture, and of points in a picture with noise.
constexpr double kUsualNoise_px = 0.1;
/// Standard deviation of the error that all blocks of an object share, px of the field's picture:
/// that of the interpolation between pixels at one fraction of a pixel. In pans without noise it is
/// between 0.01 and 0.03. No smaller noise is assumed.
constexpr double kSharedError_px = 0.025;

/// ρ of Torr's GRIC: min(e²/σ², λ₃ (r − d)), with λ₃ = 2, r = 4 coordinates of a pair, and d = 2,
/// the dimension of the set of pairs that a model allows. Every point that deviates by more than 2
/// σ is an outlier and costs the same.
constexpr double kMaxCost = 4;

inline double point_cost(const MotionModel& model, const Displacement& point, double sigma_px) {
  const double e2 = (point.moved_px - model.displacement_px(point.at_px)).squaredNorm();
  return std::min(kMaxCost, e2 / (sigma_px * sigma_px));
}

/// Σ w ρ over the points, with ρ = point_cost().
double robust_cost(const MotionModel& model, const WeightedDisplacements& evidence);

/// A model with a small robust_cost(), found in a bounded number of steps: the best of the
/// similarities through pairs of points (MSAC: Torr and Zisserman: MLESAC, 2000) and the `known`
/// models. Deviations of several px do not count as outliers yet; fit_robustly() narrows this
/// tolerance. The same evidence gives the same model, bit for bit.
MotionModel find_start(const WeightedDisplacements& evidence,
                       const std::vector<MotionModel>& known);

/// The model of the given kind to which iteratively reweighted least squares converges from
/// `start`, with the weights of Geman and McClure, 1 / (1 + e² / 4σ²)². Nothing when the points do
/// not determine it: too few, in one position, or on one line. One Gauss–Newton step to a tolerance
/// is enough for a homography, because the perspective between successive frames is small.
std::optional<MotionModel> fit_robustly(ModelKind kind, const MotionModel& start,
                                        const WeightedDisplacements& evidence);

}  // namespace spidar
