#include "core/motion/background.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

constexpr int kColumns = 8;
constexpr int kRows = 6;
constexpr double kBorderVotes = 2;
/// Of all votes; the second one for the rung in use, so that it does not flicker.
constexpr double kLeastCoverage = 0.3;
constexpr double kLeastCoverageInUse = 0.2;

/// A point is right to 0.1 px in a picture whose longer side is about 480 px, which is what the
/// tracker looks at; video that was coded badly has more noise.
constexpr double kNoiseLength_px = 480;
constexpr double kLeastNoise_px = 0.1;
constexpr double kMostNoise_px = 0.5;
constexpr double kNoiseLearnt = 0.2;  // share of the new value in each frame
constexpr size_t kLeastForNoise = 10;

/// A model explains the tracks when the mean of ρ is below this: 1.7 is the mean of noise alone at
/// exactly σ, 4 that of outliers.
constexpr double kExplained = 1.0;
constexpr double kMargin = 3;  // parameters
constexpr int kPatience = 5;
/// Climbing that did not help is not tried again for this many frames, unless the mean of ρ rose.
constexpr int kClimbInterval = 5;
constexpr double kRisen = 0.1;

double votes(int cell) {
  const int column = cell % kColumns;
  const int row = cell / kColumns;
  const bool border = column == 0 || column == kColumns - 1 || row == 0 || row == kRows - 1;
  return border ? kBorderVotes : 1;
}

constexpr double kBorderCells = 2.0 * (kColumns + kRows) - 4;
constexpr double kAllVotes = kColumns * kRows + (kBorderVotes - 1) * kBorderCells;

int cell_along(double at_px, int length_px, int cells) {
  const double share = at_px / length_px + 0.5;
  return std::min(std::max(static_cast<int>(share * cells), 0), cells - 1);
}

ModelKind next(ModelKind kind, int step) {
  return static_cast<ModelKind>(static_cast<int>(kind) + step);
}

}  // namespace

BackgroundEstimator::BackgroundEstimator() {
  evidence_.points.reserve(kMostDisplacements);
  evidence_.weights.reserve(kMostDisplacements);
  cell_of_.reserve(kMostDisplacements);
  cell_size_.reserve(kColumns * kRows);
  residuals_px_.reserve(kMostDisplacements);
  reset();
}

void BackgroundEstimator::reset() {
  background_ = Background();
  noise_px_ = kLeastNoise_px;
  patience_ = 0;
  frames_since_climb_ = kClimbInterval;
  refused_cost_ = 0;
}

/// Each cell's votes are shared by its points. The sum is the number of equally weighted points
/// that would know as much (Kish's effective sample size): with it the GRIC may be used as it
/// stands.
void BackgroundEstimator::weigh(int width, int height) {
  const size_t n = evidence_.points.size();
  cell_of_.resize(n);
  cell_size_.assign(kColumns * kRows, 0);
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& at = evidence_.points[i].at_px;
    cell_of_[i] =
        cell_along(at.y(), height, kRows) * kColumns + cell_along(at.x(), width, kColumns);
    ++cell_size_[static_cast<size_t>(cell_of_[i])];
  }
  evidence_.weights.resize(n);
  double sum = 0;  // the votes of the cells that have points
  double squares = 0;
  for (size_t i = 0; i < n; ++i) {
    evidence_.weights[i] = votes(cell_of_[i]) / cell_size_[static_cast<size_t>(cell_of_[i])];
    sum += evidence_.weights[i];
    squares += evidence_.weights[i] * evidence_.weights[i];
  }
  for (double& weight : evidence_.weights) weight *= sum / squares;
  effective_points_ = sum * sum / squares;
  covered_ = sum / kAllVotes;
}

/// Votes for the model of all votes, empty cells' too.
double BackgroundEstimator::coverage_of(const MotionModel& model) const {
  double sum = 0;
  for (size_t i = 0; i < evidence_.points.size(); ++i) {
    if (point_cost(model, evidence_.points[i], evidence_.sigma_px) < kMostCost) {
      sum += votes(cell_of_[i]) / cell_size_[static_cast<size_t>(cell_of_[i])];
    }
  }
  return sum / kAllVotes;
}

/// False when the tracks do not determine such a model, or it does not cover the frame.
bool BackgroundEstimator::score(ModelKind kind, Scored& scored) {
  const bool in_use = kind <= background_.model.kind;
  const double least = in_use ? kLeastCoverageInUse : kLeastCoverage;
  if (kind != ModelKind::kStill) {
    if (covered_ < least) return false;
    ++fitted_;
  }
  const auto model = fitter_.fit(kind, evidence_);
  if (!model) return false;
  scored.model = *model;
  scored.coverage = kind == ModelKind::kStill ? 1 : coverage_of(*model);
  if (scored.coverage < least) return false;
  scored.cost = robust_cost(*model, evidence_);
  // λ₁ d n is the same for all.
  scored.gric = scored.cost + std::log(4 * effective_points_) * parameters(kind);
  return true;
}

/// Looks for a higher rung that is better. False when none is.
bool BackgroundEstimator::climb(Scored& current) {
  const double margin = kMargin * std::log(4 * effective_points_);
  bool climbed = false;
  for (int rung = static_cast<int>(current.model.kind) + 1; rung < kModelKinds; ++rung) {
    Scored higher;
    if (!score(static_cast<ModelKind>(rung), higher)) continue;
    if (higher.gric >= current.gric - margin) continue;
    current = higher;
    climbed = true;
    if (current.cost <= kExplained * effective_points_) break;
  }
  return climbed;
}

/// Goes down to a lower rung that has been better for long enough: the next one, or none at all.
void BackgroundEstimator::descend(Scored& current) {
  Scored best = current;
  for (const ModelKind kind : {next(current.model.kind, -1), ModelKind::kStill}) {
    Scored lower;
    if (score(kind, lower) && lower.gric < best.gric) best = lower;
    if (kind == ModelKind::kStill) break;
  }
  patience_ = best.model.kind < current.model.kind ? patience_ + 1 : 0;
  if (patience_ < kPatience) return;
  patience_ = 0;
  current = best;
}

/// From the median of the inliers' residuals. More noise than before is believed only when no rung
/// explains the tracks better.
void BackgroundEstimator::learn_noise(const MotionModel& model, bool nothing_better) {
  residuals_px_.clear();
  for (const Displacement& point : evidence_.points) {
    const double e = (point.moved_px - model.displacement_px(point.at_px)).norm();
    if (e < 2 * kMostNoise_px * scale_) residuals_px_.push_back(e);
  }
  if (residuals_px_.size() < kLeastForNoise) return;
  const auto middle = residuals_px_.begin() + static_cast<ptrdiff_t>(residuals_px_.size() / 2);
  std::nth_element(residuals_px_.begin(), middle, residuals_px_.end());
  // The median of a Rayleigh distribution is σ √(2 ln 2).
  const double found_px = *middle / std::sqrt(2 * std::log(2.0)) / scale_;
  const double noise_px = std::min(std::max(found_px, kLeastNoise_px), kMostNoise_px);
  if (noise_px > noise_px_ && !nothing_better) return;
  noise_px_ += kNoiseLearnt * (noise_px - noise_px_);
}

const Background& BackgroundEstimator::estimate(const std::vector<Displacement>& points, int width,
                                                int height) {
  fitted_ = 0;
  scale_ = std::max(1.0, std::max(width, height) / kNoiseLength_px);
  evidence_.points = points;
  evidence_.sigma_px = noise_px_ * scale_;
  background_.sigma_px = evidence_.sigma_px;
  if (points.empty()) {
    background_.model = MotionModel();
    background_.coverage = 1;
    return background_;
  }
  weigh(width, height);

  Scored current;
  if (!score(background_.model.kind, current)) score(ModelKind::kStill, current);
  const double cost = current.cost / effective_points_;
  const bool explained = cost <= kExplained;
  ++frames_since_climb_;
  bool climbed = false;
  if (!explained && (frames_since_climb_ >= kClimbInterval || cost > refused_cost_ + kRisen)) {
    climbed = climb(current);
    frames_since_climb_ = climbed ? kClimbInterval : 0;
    refused_cost_ = cost;
  }
  if (climbed) {
    patience_ = 0;
  } else if (current.model.kind != ModelKind::kStill) {
    descend(current);
  }
  learn_noise(current.model, !climbed);
  background_.model = current.model;
  background_.coverage = current.coverage;
  return background_;
}

}  // namespace spidar
