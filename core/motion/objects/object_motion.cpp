// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/object_motion.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Windows are used instead of the blocks if there are this many that move as the blocks do: two
/// more than determine a similarity.
constexpr size_t kLeastWindows = 4;

}  // namespace

ObjectMeter::ObjectMeter() {
  collected_.points.reserve(kMostDisplacements);
  collected_.weights.reserve(kMostDisplacements);
}

/// Collects the blocks of an object that show how they move.
void ObjectMeter::collect_blocks(uint32_t key, const ObjectEvidence& evidence) {
  collected_.points.clear();
  const std::vector<MotionBlock>& blocks = evidence.field.blocks();
  for (size_t i = 0; i < evidence.owners.size(); ++i) {
    const RelativeBlock& relative = evidence.relative[i];
    if (evidence.owners[i] != key || !relative.shows_motion) continue;
    if (collected_.points.size() >= kMostDisplacements) break;
    const Eigen::Vector2d moved_px = relative.moved_px.cast<double>();
    collected_.points.push_back({blocks[i].centre_px.cast<double>() - moved_px, moved_px});
  }
  collected_.weights.assign(collected_.points.size(), 1.0);
  collected_.sigma_px = 2 * evidence.background.sigma_px;
}

/// Collects the windows on the object whose motion is close to `motion`. Returns false when they
/// are too few.
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
  return collected_.points.size() >= kLeastWindows;
}

/// Chooses a similarity if it is better than a translation by its price in the GRIC, and again by
/// the same amount so that the choice does not flicker.
void ObjectMeter::climb(MotionModel& motion) {
  if (motion.kind == ModelKind::kSimilarity) return;
  const auto similarity = fitter_.refine(ModelKind::kSimilarity, motion, collected_);
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
  climb(found.model);
  found.points = static_cast<int>(collected_.points.size());
  if (collect_windows(key, found.model, evidence)) {
    const auto refined = fitter_.refine(found.model.kind, found.model, collected_);
    if (refined) found.model = *refined;
    climb(found.model);
    found.points = static_cast<int>(collected_.points.size());
    found.relative_px = found.model.displacement_px(region.position_px - region.relative_px);
  }
  return found;
}

}  // namespace spidar
