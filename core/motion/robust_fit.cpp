#include "core/motion/robust_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace spidar {
namespace {

constexpr int kSamplesForEachPoint = 32;
constexpr double kMissed = 0.01;  // accepted chance that no sample was free of outliers
constexpr int kFinalRefits = 3;

struct Candidate {
  MotionModel model;
  double cost;
};

/// Points in proportion to their weights. std::minstd_rand is the same on every machine; the
/// distributions of <random> are not.
class Sampler {
 public:
  /// `sums` is memory to use.
  Sampler(const std::vector<double>& weights, std::vector<double>& sums) : sums_(sums) {
    sums_.clear();
    double sum = 0;
    for (const double weight : weights) sums_.push_back(sum += weight);
  }

  size_t draw() {
    const double span = static_cast<double>(std::minstd_rand::max() - std::minstd_rand::min());
    const double place = static_cast<double>(random_() - std::minstd_rand::min()) / span;
    const auto found = std::lower_bound(sums_.begin(), sums_.end(), place * sums_.back());
    return std::min(static_cast<size_t>(found - sums_.begin()), sums_.size() - 1);
  }

  double sum() const { return sums_.back(); }

 private:
  std::vector<double>& sums_;
  std::minstd_rand random_;
};

/// Weights of the model's inliers, 0 for the others; their sum.
double inlier_weights(const MotionModel& model, const WeightedTracks& evidence,
                      std::vector<double>& inliers) {
  double sum = 0;
  for (size_t i = 0; i < evidence.points.size(); ++i) {
    const bool inlier = point_cost(model, evidence.points[i], evidence.sigma_px) < kMostCost;
    inliers[i] = inlier ? evidence.weights[i] : 0;
    sum += inliers[i];
  }
  return sum;
}

/// Fits to the inliers of `best`; false when that is no better.
bool refit(const WeightedTracks& evidence, std::vector<double>& inliers, Candidate& best) {
  const auto model = fit_model(best.model.kind, evidence.points, inliers);
  if (!model) return false;
  const double cost = robust_cost(*model, evidence, best.cost);
  if (!(cost < best.cost)) return false;
  best = {*model, cost};
  inlier_weights(best.model, evidence, inliers);
  return true;
}

/// Samples that are needed so that one is free of outliers.
int samples_needed(double inlier_share, int points) {
  const double good = std::pow(std::min(inlier_share, 1.0), points);
  if (good >= 1 - kMissed) return 1;
  return static_cast<int>(std::min(1e6, std::ceil(std::log(kMissed) / std::log1p(-good))));
}

}  // namespace

double robust_cost(const MotionModel& model, const WeightedTracks& evidence, double limit) {
  double cost = 0;
  for (size_t i = 0; i < evidence.points.size() && cost <= limit; ++i) {
    cost += evidence.weights[i] * point_cost(model, evidence.points[i], evidence.sigma_px);
  }
  return cost;
}

RobustFitter::RobustFitter() {
  constexpr auto kMostToSample = static_cast<size_t>(least_points(ModelKind::kHomography));
  weight_sums_.reserve(kMostDisplacements);
  inliers_.reserve(kMostDisplacements);
  sample_.reserve(kMostToSample);
  ones_.reserve(kMostToSample);
}

std::optional<MotionModel> RobustFitter::fit(ModelKind kind, const WeightedTracks& evidence) {
  const auto size = static_cast<size_t>(least_points(kind));
  const size_t n = evidence.points.size();
  if (size == 0) return MotionModel();
  if (n < size) return std::nullopt;

  Sampler sampler(evidence.weights, weight_sums_);
  sample_.resize(size);
  ones_.assign(size, 1.0);
  inliers_.resize(n);
  std::optional<Candidate> best;
  int needed = kSamplesForEachPoint * static_cast<int>(size);
  for (int k = 0; k < needed; ++k) {
    for (Displacement& point : sample_) point = evidence.points[sampler.draw()];
    const auto model = fit_model(kind, sample_, ones_);
    if (!model) continue;
    const double limit = best ? best->cost : 1e300;
    const double cost = robust_cost(*model, evidence, limit);
    if (!(cost < limit)) continue;
    best = {*model, cost};
    inlier_weights(best->model, evidence, inliers_);
    refit(evidence, inliers_, *best);
    double share = 0;
    for (const double weight : inliers_) share += weight;
    share /= sampler.sum();
    needed = std::min(needed, samples_needed(share, static_cast<int>(size)));
  }
  if (!best) return std::nullopt;
  for (int k = 0; k < kFinalRefits; ++k) {
    if (!refit(evidence, inliers_, *best)) break;
  }
  return best->model;
}

}  // namespace spidar
