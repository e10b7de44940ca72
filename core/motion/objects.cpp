#include "core/motion/objects.h"

#include <algorithm>
#include <cmath>

#include "core/motion/salience.h"

namespace spidar {
namespace {

/// Regions are the same object when their motions differ by less than this share, plus this much.
constexpr double kSameMotion = 0.5;
constexpr double kSameMotion_px = 1;
/// An object is what was seen in so many frames, with so many blocks in all of them together: what
/// is small has to be seen more often.
constexpr int kBornAfter = 2;
constexpr int kBornAfterBlocks = 8;
/// Where an object is expected that was not seen, as a share of the sum of both boxes' sides.
constexpr double kReach = 0.75;
/// An object that is lost goes on for this long: its blocks fail for a frame or two now and then.
constexpr double kCoast_s = 0.05;
/// Share of the new value in the velocity of an object that is not rigid, which thereby is late by
/// a frame.
constexpr double kNewest = 0.5;
/// A camera slower than this is still, px of the field's picture a frame.
constexpr double kCameraStill_px = 0.25;
/// An object turns or grows when this many blocks say so and the GRIC finds it worth it.
constexpr size_t kLeastForSimilarity = 6;
/// Motion of the blocks of one object differs by this share besides the noise: it is not rigid.
constexpr double kObjectNoiseShare = 0.1;
/// Points are the object's own when they move as the median of its blocks does, up to this share of
/// it and so many px of the field's picture; so many of them say more than the blocks.
constexpr double kPointReachShare = 0.35;
constexpr double kPointReach_px = 0.5;
constexpr double kLeastPoints = 4;
constexpr double kPointShare = 0.5;
/// Noise of a point's displacement, px of the field's picture, and a share of the displacement.
constexpr double kPointNoise_px = 0.1;
constexpr double kPointNoiseShare = 0.03;
/// Its points agree with one motion when the mean of ρ is below this; 4 is that of outliers.
constexpr double kRigid = 1;
/// An object that was none of the scene's layers for so many frames may become more like one.
constexpr int kProvenAfter = 3;
/// What is larger than this share of the picture is no object but an error of the background; much
/// less of it where hardly anything speaks for the background.
constexpr double kMostOfPicture = 0.75;
constexpr double kMostOfUnknown = 0.4;
constexpr double kKnownCoverage = 0.07;

}  // namespace

bool ObjectTracker::Life::is_born() const {
  return frames_seen >= kBornAfter && blocks_seen >= kBornAfterBlocks;
}

ObjectTracker::ObjectTracker() {
  lives_.reserve(kMostObjects);
  region_ids_.reserve(RegionFinder::kMostRegions);
  order_.reserve(RegionFinder::kMostRegions);
  objects_.reserve(kMostObjects);
  evidence_.points.reserve(kMostDisplacements);
  evidence_.weights.reserve(kMostDisplacements);
}

void ObjectTracker::reset() {
  moving_.reset();
  owners_.clear();
  lives_.clear();
  objects_.clear();
}

bool ObjectTracker::is_same_motion(const Life& life, const Region& region,
                                   const FieldInFrame& frame) const {
  const Eigen::Vector2d expected_px = life.velocity_px_s * frame.interval_s;
  const double fastest_px = std::max(expected_px.norm(), region.relative_px.norm());
  return (region.relative_px - expected_px).norm() < kSameMotion * fastest_px + kSameMotion_px;
}

/// The object that most of the region's blocks were on; null when that is none.
ObjectTracker::Life* ObjectTracker::owner_of(int16_t region) {
  Life* best = nullptr;
  int most = 0;
  for (Life& life : lives_) {
    int votes = 0;
    for (size_t i = 0; i < owners_before_.size(); ++i) {
      votes += finder_.labels()[i] == region && owners_before_[i] == life.object.id;
    }
    if (votes > most) {
      most = votes;
      best = &life;
    }
  }
  return best;
}

/// The object out of sight that is expected there with such a motion; null when there is none.
ObjectTracker::Life* ObjectTracker::expected_at(const Region& region, const FieldInFrame& frame) {
  for (Life& life : lives_) {
    if (life.claimed || !life.is_born()) continue;
    const Eigen::Vector2d sides_px =
        (life.region.high_px - life.region.low_px) + (region.high_px - region.low_px);
    const Eigen::Vector2d apart_px = (life.region.position_px - region.position_px).cwiseAbs();
    if ((apart_px.array() < kReach * sides_px.array()).all() &&
        is_same_motion(life, region, frame)) {
      return &life;
    }
  }
  return nullptr;
}

/// The id of a new object; 0 when there are too many.
uint32_t ObjectTracker::create(const Region& region) {
  if (lives_.size() >= kMostObjects) return 0;
  lives_.emplace_back();
  Life& life = lives_.back();
  life.object.id = next_id_++;
  life.region = region;
  life.claimed = true;
  return life.object.id;
}

/// Gives each region to an object. The largest of those of an object is the object.
void ObjectTracker::claim(const FieldInFrame& frame) {
  const std::vector<Region>& regions = finder_.find(frame.field, *relative_);
  region_ids_.assign(regions.size(), 0);
  for (Life& life : lives_) life.claimed = false;
  order_.resize(regions.size());
  for (size_t k = 0; k < order_.size(); ++k) order_[k] = k;
  std::sort(order_.begin(), order_.end(),
            [&](size_t a, size_t b) { return regions[a].blocks > regions[b].blocks; });
  for (const size_t k : order_) {
    const Region& region = regions[k];
    Life* life = owner_of(static_cast<int16_t>(k));
    if (life && life->claimed) {
      if (is_same_motion(*life, region, frame)) {
        region_ids_[k] = life->object.id;
        continue;
      }
      life = nullptr;
    }
    // Noise does not move alike twice.
    if (life && !life->is_born() && !is_same_motion(*life, region, frame)) {
      life = nullptr;
    }
    if (!life) life = expected_at(region, frame);
    if (!life) {
      region_ids_[k] = create(region);
      continue;
    }
    life->claimed = true;
    life->region = region;
    region_ids_[k] = life->object.id;
  }
}

/// The blocks of an object that show how they move.
void ObjectTracker::collect_blocks(const Life& life, const FieldInFrame& frame) {
  evidence_.points.clear();
  const std::vector<MotionBlock>& blocks = frame.field.blocks();
  for (size_t i = 0; i < owners_.size(); ++i) {
    const RelativeBlock& relative = (*relative_)[i];
    if (owners_[i] != life.object.id || !relative.has_texture) continue;
    if (evidence_.points.size() >= kMostDisplacements) break;
    const Eigen::Vector2d moved_px(relative.x_px, relative.y_px);
    const Eigen::Vector2d at_px(blocks[i].x_px, blocks[i].y_px);
    evidence_.points.push_back({0, at_px - moved_px, moved_px});
  }
  evidence_.weights.assign(evidence_.points.size(), 1.0);
  evidence_.sigma_px =
      std::max(2 * background_->sigma_px, kObjectNoiseShare * life.region.relative_px.norm());
}

/// Points on the object that move about as `motion` says. False when they are too few.
bool ObjectTracker::collect_points(const Life& life, const MotionModel& motion,
                                   const FieldInFrame& frame) {
  evidence_.points.clear();
  for (const PlacedPoint& point : frame.points) {
    if (owners_[point.block] != life.object.id) continue;
    Displacement relative = point.moved;
    relative.moved_px -= background_->model.displacement_px(relative.at_px);
    const Eigen::Vector2d expected_px = motion.displacement_px(relative.at_px);
    const double reach_px = kPointReachShare * expected_px.norm() + kPointReach_px;
    if ((relative.moved_px - expected_px).norm() < reach_px) evidence_.points.push_back(relative);
  }
  evidence_.weights.assign(evidence_.points.size(), 1.0);
  evidence_.sigma_px = std::max(kPointNoise_px, kPointNoiseShare * life.region.relative_px.norm());
  const auto n = static_cast<double>(evidence_.points.size());
  return n >= kLeastPoints && n >= kPointShare * life.region.blocks;
}

/// A similarity if that explains the evidence better by its price in the GRIC, and by as much again
/// so that it does not flicker.
void ObjectTracker::climb(MotionModel& motion) {
  const size_t n = evidence_.points.size();
  if (motion.kind == ModelKind::kSimilarity || n < kLeastForSimilarity) return;
  const auto similarity = fitter_.refine(ModelKind::kSimilarity, motion, evidence_);
  const double price = 4 * std::log(4 * static_cast<double>(n));
  if (similarity && robust_cost(*similarity, evidence_) + price < robust_cost(motion, evidence_)) {
    motion = *similarity;
  }
}

/// The blocks tell how the object moves, and the points on it to a fraction of a pixel.
void ObjectTracker::measure(Life& life, const FieldInFrame& frame) {
  MotionModel motion;
  motion.kind = ModelKind::kTranslation;
  motion.shift_px = life.region.relative_px;
  collect_blocks(life, frame);
  climb(motion);
  MovingObject& object = life.object;
  object.tracks = static_cast<int>(evidence_.points.size());
  life.is_rigid = false;
  if (collect_points(life, motion, frame)) {
    const auto refined = fitter_.refine(motion.kind, motion, evidence_);
    if (refined) motion = *refined;
    climb(motion);
    const auto n = static_cast<double>(evidence_.points.size());
    object.tracks = static_cast<int>(n);
    life.is_rigid = robust_cost(motion, evidence_) < kRigid * n;
    life.region.relative_px =
        motion.displacement_px(life.region.position_px - life.region.relative_px);
  }
  object.model = motion.kind;
  object.growth_1_s = motion.growth() / frame.interval_s;
  object.roll_rad_s = motion.roll_rad() / frame.interval_s;
  object.noise_px_s = frame.scale * evidence_.sigma_px / 2 /
                      std::sqrt(static_cast<double>(std::max(object.tracks, 1))) / frame.interval_s;
}

/// Place and velocity in the frame, from those of the region in the field's picture.
void ObjectTracker::place(Life& life, const FieldInFrame& frame) const {
  MovingObject& object = life.object;
  const Region& region = life.region;
  object.position_px = frame.scale * region.position_px + frame.offset_px;
  object.size_px = frame.scale * (region.high_px - region.low_px);
  object.area_px2 = frame.scale * frame.scale * region.blocks * kBlockArea_px;
  object.relative_px_s = frame.scale * life.velocity_px_s;
  object.on_screen_px_s =
      object.relative_px_s + frame.scale * region.background_px / frame.interval_s;
}

void ObjectTracker::observe(Life& life, const FieldInFrame& frame) {
  measure(life, frame);
  const Eigen::Vector2d velocity_px_s = life.region.relative_px / frame.interval_s;
  const bool goes_on = life.frames_seen > 0 && velocity_px_s.dot(life.velocity_px_s) > 0;
  const double share = life.is_rigid || !goes_on ? 1 : kNewest;
  life.velocity_px_s += share * (velocity_px_s - life.velocity_px_s);
  ++life.frames_seen;
  life.blocks_seen += life.region.blocks;
  life.unseen_s = 0;
  life.resting_s = 0;
  place(life, frame);
  MovingObject& object = life.object;
  const double known = background_->coverage < kKnownCoverage ? kMostOfUnknown : kMostOfPicture;
  const bool too_large = life.region.blocks > known * static_cast<double>(owners_.size());
  life.proven += salience(life.region, camera_, false) > 0;
  object.prominence = too_large ? 0 : salience(life.region, camera_, life.proven >= kProvenAfter);
  life.is_layer = object.prominence == 0;
}

/// Its place shows nothing that moves by itself: it rests there, or it is out of sight.
void ObjectTracker::miss(Life& life, const FieldInFrame& frame) {
  int resting = 0;  // blocks
  for (size_t i = 0; i < owners_before_.size(); ++i) {
    if (owners_before_[i] != life.object.id || finder_.labels()[i] != kNoRegion) continue;
    owners_[i] = life.object.id;
    if (!(*relative_)[i].has_texture) continue;
    ++resting;
  }
  MovingObject& object = life.object;
  if (resting > 0) {
    life.velocity_px_s.setZero();
    life.resting_s += frame.interval_s;
    life.unseen_s = 0;
    object.tracks = resting;
  } else {
    object.tracks = 0;
    life.unseen_s += frame.interval_s;
  }
  object.growth_1_s = 0;
  object.roll_rad_s = 0;
  life.region.position_px += life.velocity_px_s * frame.interval_s + life.region.background_px;
  object.prominence = 0;
  place(life, frame);
}

const std::vector<MovingObject>& ObjectTracker::update(const FieldInFrame& frame,
                                                       const Background& background) {
  const BlockField& field = frame.field;
  const size_t n = field.blocks().size();
  if (owners_.size() != n) owners_.assign(n, 0);
  owners_before_.resize(n);
  expected_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    owners_before_[i] = owners_[origin_of(field, i)];
    const uint32_t owner = owners_before_[i];
    expected_[i] = owner != 0 && std::any_of(lives_.begin(), lives_.end(), [&](const Life& life) {
                     return life.object.id == owner && life.is_born();
                   });
  }
  background_ = &background;
  relative_ = &moving_.find(field, background, expected_);
  camera_ = {0, kCameraStill_px};
  for (const RelativeBlock& block : *relative_) {
    camera_.speed_px += std::hypot(block.background_x_px, block.background_y_px);
  }
  camera_.speed_px /= static_cast<double>(std::max<size_t>(n, 1));

  claim(frame);
  for (size_t i = 0; i < n; ++i) {
    const int16_t label = finder_.labels()[i];
    owners_[i] = label == kNoRegion ? 0 : region_ids_[static_cast<size_t>(label)];
  }
  for (Life& life : lives_) {
    if (life.claimed) {
      observe(life, frame);
    } else {
      miss(life, frame);
    }
  }
  const auto is_over = [](const Life& life) {
    return (!life.is_born() && !life.claimed) || life.unseen_s > kForgotten_s ||
           life.resting_s > kAtRest_s;
  };
  lives_.erase(std::remove_if(lives_.begin(), lives_.end(), is_over), lives_.end());

  objects_.clear();
  for (const Life& life : lives_) {
    if (!life.is_born() || life.is_layer) continue;
    objects_.push_back(life.object);
    if (life.unseen_s <= kCoast_s) continue;
    objects_.back().relative_px_s.setZero();
    objects_.back().on_screen_px_s.setZero();
  }
  return objects_;
}

}  // namespace spidar
