// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fits motion models to displacements some of which are outliers.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/motion/camera/motion_models.h"

namespace spidar {

/// The displacements to be explained.
struct WeightedDisplacements {
  std::vector<Displacement> points;
  std::vector<double> weights;  ///< ≥ 0, one for each point
  double sigma_px = 1;          ///< noise of a displacement, each coordinate, > 0
};

/// Samples in which the best is looked for. When half of the votes belong to the background, one
/// pair in four has no outlier, and with a probability of 1e-5 none of so many pairs is.
constexpr size_t kMostTries = 40;

/// Noise of a displacement where it has not been measured, each coordinate, px of the field's
/// picture: that of blocks with much texture, and of points in a picture with noise.
constexpr double kUsualNoise_px = 0.1;
/// Standard deviation of what is the same for all blocks of an object, px of the field's picture:
/// how far the interpolation between pixels is off at one fraction of a pixel. Of pans without
/// noise it is between 0.01 and 0.03. No noise is assumed to be less.
constexpr double kSharedError_px = 0.025;

/// ρ of Torr's GRIC: min(e²/σ², λ₃ (r − d)), with λ₃ = 2, r = 4 coordinates of a pair, and d = 2,
/// the dimension of the set of pairs that a model allows. Every point that deviates by more than 2
/// σ is an outlier and costs the same.
constexpr double kMostCost = 4;

inline double point_cost(const MotionModel& model, const Displacement& point, double sigma_px) {
  const double e2 = (point.moved_px - model.displacement_px(point.at_px)).squaredNorm();
  return std::min(e2 / (sigma_px * sigma_px), kMostCost);
}

/// Σ w ρ.
double robust_cost(const MotionModel& model, const WeightedDisplacements& evidence);

/// Finds models with a small robust_cost() in a bounded number of steps. The same evidence gives
/// the same model, bit for bit. Allocates nothing for up to kMostDisplacements points.
class RobustFitter {
 public:
  RobustFitter();

  /// The best of the similarities through pairs of points (MSAC: Torr and Zisserman: MLESAC, 2000)
  /// and the `known` models, where deviations of several px count as less than outliers: refine()
  /// narrows that.
  MotionModel start(const WeightedDisplacements& evidence, const std::vector<MotionModel>& known);

  /// The model of the given kind to which iteratively reweighted least squares converges from
  /// `start`, with the weights of Geman and McClure, 1 / (1 + e² / 4σ²)². Nothing when the points
  /// do not determine it.
  std::optional<MotionModel> refine(ModelKind kind, const MotionModel& start,
                                    const WeightedDisplacements& evidence);

 private:
  std::vector<double> weights_;
};

}  // namespace spidar
