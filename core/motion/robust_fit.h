/// Models of tracks some of which belong to something else.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/api.h"
#include "core/motion/motion_models.h"

namespace spidar {

/// Tracks to explain.
struct WeightedTracks {
  std::vector<Displacement> points;
  std::vector<double> weights;  ///< ≥ 0, one a point
  double sigma_px = 1;          ///< noise of a displacement, each coordinate, > 0
};

/// ρ of Torr's GRIC: min(e²/σ², λ₃ (r − d)), with λ₃ = 2, r = 4 coordinates of a track, and d = 2,
/// the dimension of the set of tracks that a model allows. A point further off than 2 σ is an
/// outlier, however far.
constexpr double kMostCost = 4;

inline double point_cost(const MotionModel& model, const Displacement& point, double sigma_px) {
  const double e2 = (point.moved_px - model.displacement_px(point.at_px)).squaredNorm();
  return std::min(e2 / (sigma_px * sigma_px), kMostCost);
}

/// Σ w ρ. Gives up above `limit` and returns something larger.
SPIDAR_API double robust_cost(const MotionModel& model, const WeightedTracks& evidence,
                              double limit = 1e300);

/// Finds the model of least robust_cost() among those that a bounded number of random samples lead
/// to (MSAC: Torr and Zisserman 2000; refined locally: Chum, Matas and Kittler 2003). Points are
/// drawn by their weights. The same evidence gives the same model, bit for bit. Keeps nothing from
/// one fit to the next but its memory, which is enough for kMostDisplacements.
class SPIDAR_API RobustFitter {
 public:
  RobustFitter();

  /// At most 32 samples a parameter pair, fewer when a good model is found early (99 % confidence).
  /// Nothing when the points do not determine the model.
  std::optional<MotionModel> fit(ModelKind kind, const WeightedTracks& evidence);

 private:
  std::vector<double> weight_sums_;
  std::vector<double> inliers_;
  std::vector<Displacement> sample_;
  std::vector<double> ones_;
};

}  // namespace spidar
