// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/object_motion.h"

#include <algorithm>

#include "core/quantile.h"

namespace spidar {
namespace {

/// Windows replace the blocks if this many move alike: two more than determine a similarity.
constexpr size_t kMinWindows = 4;

}  // namespace

ObjectMeter::ObjectMeter() {
  collected_.points.reserve(kMaxDisplacements);
  collected_.weights.reserve(kMaxDisplacements);
}

/// Collects the blocks that show how the object moves.
void ObjectMeter::collect_blocks(uint32_t key, const ObjectEvidence& evidence) {
  collected_.points.clear();
  const std::vector<MotionBlock>& blocks = evidence.field.blocks();
  for (size_t i = 0; i < evidence.owners.size(); ++i) {
    const RelativeBlock& relative = evidence.relative[i];
    if (evidence.owners[i] != key || !relative.shows_motion) continue;
    if (collected_.points.size() >= kMaxDisplacements) break;
    const Eigen::Vector2d moved_px = relative.moved_px.cast<double>();
    collected_.points.push_back({blocks[i].centre_px.cast<double>() - moved_px, moved_px});
  }
  collected_.weights.assign(collected_.points.size(), 1.0);
  collected_.sigma_px = 2 * evidence.background.sigma_px;
}

/// Collects the object's windows that move like `motion`. Returns false when they are too few.
bool ObjectMeter::collect_windows(uint32_t key, const MotionModel& motion,
                                  const ObjectEvidence& evidence) {
  collected_.points.clear();
  for (const FineMotion& window : evidence.fine) {
    if (evidence.owners[window.block] != key) continue;
    Displacement relative{window.from_px, window.moved_px};
    relative.moved_px -= evidence.background.model.displacement_px(relative.at_px);
    const Eigen::Vector2d expected_px = motion.displacement_px(relative.at_px);
    const double apart_px = (relative.moved_px - expected_px).norm();
    if (apart_px < alike_px(expected_px.norm())) collected_.points.push_back(relative);
  }
  collected_.weights.assign(collected_.points.size(), 1.0);
  collected_.sigma_px = kUsualNoise_px;
  return collected_.points.size() >= kMinWindows;
}

/// Chooses a similarity if its cost is below that of a translation by twice the difference of their
/// penalties in the GRIC. With the difference itself, which the GRIC demands, the choice would
/// flicker.
void ObjectMeter::choose_similarity(MotionModel& motion) {
  if (motion.kind == ModelKind::kSimilarity) return;
  const auto similarity = fit_robustly(ModelKind::kSimilarity, motion, collected_);
  const double price = 4 * std::log(4 * static_cast<double>(collected_.points.size()));
  if (similarity &&
      robust_cost(*similarity, collected_) + price < robust_cost(motion, collected_)) {
    motion = *similarity;
  }
}

ObjectMotion ObjectMeter::measure(uint32_t key, const Region& region,
                                  const ObjectEvidence& evidence) {
  ObjectMotion found;
  found.model.kind = ModelKind::kTranslation;
  found.model.shift_px = region.relative_px;
  found.relative_px = region.relative_px;
  collect_blocks(key, evidence);
  choose_similarity(found.model);
  found.points = static_cast<int>(collected_.points.size());
  if (collect_windows(key, found.model, evidence)) {
    const auto refined = fit_robustly(found.model.kind, found.model, collected_);
    if (refined) found.model = *refined;
    choose_similarity(found.model);
    found.points = static_cast<int>(collected_.points.size());
    found.relative_px = found.model.displacement_px(region.position_px - region.relative_px);
  }
  return found;
}

namespace {

/// The background is compared with its model up to this far from the object's box: two blocks and a
/// half, so that two whole ones are within it.
constexpr double kAround_px = 2.5 * kBlock_px;
/// Variance of a median over that of a mean.
constexpr double kMedianVariance = M_PI / 2;

bool is_around(const Region& region, const Eigen::Vector2d& at_px) {
  const double outside_px = (region.low_px - at_px).cwiseMax(at_px - region.high_px).maxCoeff();
  return outside_px > 0 && outside_px < kAround_px;
}

}  // namespace

ErrorBound::ErrorBound() {
  squares_px2_.reserve(kMaxDisplacements);
  beside_px_.reserve(kMaxDisplacements);
}

/// The variance of each coordinate that comes from the object's blocks: that of their median, and
/// that of the least squares over all their pixels, mean residual / Σ g gᵀ, in its worst direction.
/// Blocks do not overlap, so each is an independent measurement.
double ErrorBound::own_variance_px2(uint32_t key, const ObjectMotion& found,
                                    const ObjectEvidence& evidence) {
  squares_px2_.clear();
  Eigen::Matrix2f structure = Eigen::Matrix2f::Zero();
  float residual = 0;
  for (size_t i = 0; i < evidence.owners.size(); ++i) {
    const RelativeBlock& relative = evidence.relative[i];
    if (evidence.owners[i] != key || !relative.shows_motion) continue;
    const MotionBlock& block = evidence.field.blocks()[i];
    const Eigen::Vector2d moved_px = relative.moved_px.cast<double>();
    const Eigen::Vector2d from_px = block.centre_px.cast<double>() - moved_px;
    squares_px2_.push_back((moved_px - found.model.displacement_px(from_px)).squaredNorm());
    structure += block.structure;
    residual += block.residual;
  }
  if (squares_px2_.empty()) return 0;
  const auto n = static_cast<double>(squares_px2_.size());
  const double middle_px2 = median(squares_px2_.begin(), squares_px2_.end());
  const double texture =
      static_cast<double>(std::max(smaller_eigenvalue(structure), MotionBlock::kMinTexture));
  return kMedianVariance * middle_px2 / (kRayleighMedian * kRayleighMedian * n) +
         static_cast<double>(residual) / (n * kBlockArea_px * texture);
}

/// The variance that comes from the background: the median of its model's residuals beside the
/// object or, if no block there shows the background, the noise of a single block.
double ErrorBound::background_variance_px2(const Region& region, const ObjectEvidence& evidence) {
  beside_px_.clear();
  for (size_t i = 0; i < evidence.owners.size(); ++i) {
    const MotionBlock& block = evidence.field.blocks()[i];
    const RelativeBlock& relative = evidence.relative[i];
    if (evidence.owners[i] != 0 || relative.was_outside || !block.has_corners()) continue;
    if (is_around(region, block.centre_px.cast<double>())) beside_px_.push_back(relative.moved_px);
  }
  const bool moves = evidence.background.model.kind != ModelKind::kStill;
  const double shared_px2 = moves ? kSharedError_px * kSharedError_px : 0;
  if (beside_px_.empty()) {
    const double noise_px = moves ? evidence.background.sigma_px : 0;
    return shared_px2 + noise_px * noise_px;
  }
  return shared_px2 + median_of_each(beside_px_).cast<double>().squaredNorm() / 2;
}

double ErrorBound::px(uint32_t key, const Region& region, const ObjectMotion& found,
                      const ObjectEvidence& evidence) {
  return kErrorSigmas *
         std::sqrt(own_variance_px2(key, found, evidence) +
                   background_variance_px2(region, evidence) + kSharedError_px * kSharedError_px);
}

}  // namespace spidar
