// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fits motion models to displacements some of which are outliers.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/motion/motion_models.h"

namespace spidar {

/// The displacements to be explained.
struct WeightedDisplacements {
  std::vector<Displacement> points;
  std::vector<double> weights;  ///< ≥ 0, one for each point
  double sigma_px = 1;          ///< noise of a displacement, each coordinate, > 0
};

/// ρ of Torr's GRIC: min(e²/σ², λ₃ (r − d)), with λ₃ = 2, r = 4 coordinates of a track, and d = 2,
/// the dimension of the set of tracks that a model allows. Every point that deviates by more than 2
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
  /// and the `known` models, where deviations of up to 32 σ count as less than outliers: refine()
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
