// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/object_tracker.h"

#include <numeric>
#include <utility>

#include "core/motion/layers/burned_in.h"

namespace spidar {
namespace {

/// How far from its expected position an object may reappear, as a fraction of the sum of both
/// boxes' sides.
constexpr double kReach = 0.75;
/// Fewer blocks are no region of an object yet, see is_enough().
constexpr int kMinBlocks = 2;

/// The fraction of its usual blocks that an object at rest still has where it was.
constexpr double kRemainingFraction = 0.5;

}  // namespace

ObjectTracker::ObjectTracker(std::shared_ptr<uint32_t> next_id) : next_id_(std::move(next_id)) {
  tracks_.reserve(kMaxObjects);
  region_keys_.reserve(RegionFinder::kMaxRegions);
  order_.reserve(RegionFinder::kMaxRegions);
  objects_.reserve(kMaxObjects);
}

void ObjectTracker::reset() {
  moving_.reset();
  owners_.clear();
  tracks_.clear();
  objects_.clear();
}

/// The object to which most blocks of the region belonged; null when most belonged to none.
Track* ObjectTracker::owner_of(int16_t region) {
  Track* best = nullptr;
  int most = 0;
  for (Track& track : tracks_) {
    int votes = 0;
    for (size_t i = 0; i < owners_before_.size(); ++i) {
      votes += finder_.labels()[i] == region && owners_before_[i] == track.key;
    }
    if (votes > most) {
      most = votes;
      best = &track;
    }
  }
  return best;
}

/// The invisible object that is expected nearest to the region with a similar motion, or that has
/// bounced and may be there; null when there is none.
Track* ObjectTracker::expected_at(const Region& region, const FieldInFrame& frame) {
  Track* best = nullptr;
  double nearest_px = 0;
  for (Track& track : tracks_) {
    if (track.is_seen() || !track.is_confirmed()) continue;
    const Eigen::Vector2d sides_px = track.expected.sides_px + region.high_px - region.low_px;
    const Eigen::Vector2d apart_px = (track.expected.position_px - region.position_px).cwiseAbs();
    const bool goes_on = track.moves_like(region, frame.interval_s) &&
                         (apart_px.array() < kReach * sides_px.array()).all();
    if (!goes_on && !track.has_bounced_to(region, frame.interval_s)) continue;
    if (best && apart_px.norm() >= nearest_px) continue;
    best = &track;
    nearest_px = apart_px.norm();
  }
  return best;
}

/// The key of a new object; 0 when there are too many.
uint32_t ObjectTracker::create(const Region& region) {
  if (tracks_.size() >= kMaxObjects) return 0;
  tracks_.emplace_back();
  Track& track = tracks_.back();
  track.key = next_key_++;
  track.region = region;
  return track.key;
}

/// Counts the former blocks of an object that do not clearly move by themselves now, are found in
/// the picture before, and are not plain. Returns nothing unless they are most of its usual blocks.
std::optional<int> ObjectTracker::resting_blocks(const Track& track,
                                                 const BlockField& field) const {
  int blocks = 0, found = 0;
  for (size_t i = 0; i < owners_before_.size(); ++i) {
    if (owners_before_[i] != track.key || finder_.labels()[i] != kNoRegion) continue;
    ++blocks;
    found += (*relative_)[i].shows_motion || field.match_of(i) == BlockField::Match::kFound;
  }
  if (blocks < kRemainingFraction * track.expected.blocks) return std::nullopt;
  return found;
}

/// Whether a region is large enough to be an object, `track` if that is not null. A single block is
/// enough for what is left of a known object, and for a new object if the block lasts. If most of a
/// known object stands still beside the block, the object comes to rest and the block is its rim.
bool ObjectTracker::is_enough(const Region& region, const Track* track,
                              const BlockField& field) const {
  if (region.blocks >= kMinBlocks) return true;
  if (!track || !track->is_confirmed()) return region.lasts;
  const bool is_rim = track->is_rim(region) && resting_blocks(*track, field);
  return !track->is_layer && !is_rim;
}

/// Assigns each region to an object. The largest of several regions of an object counts.
void ObjectTracker::assign_regions(const FieldInFrame& frame) {
  const std::vector<Region>& regions = finder_.find(frame.field, *relative_);
  region_keys_.assign(regions.size(), 0);
  for (Track& track : tracks_) {
    if (track.is_seen()) track.set_state(Track::State::kHidden);
  }
  order_.resize(regions.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  std::sort(order_.begin(), order_.end(),
            [&](size_t a, size_t b) { return regions[a].blocks > regions[b].blocks; });
  for (const size_t k : order_) {
    const Region& region = regions[k];
    Track* track = owner_of(static_cast<int16_t>(k));
    if (track && track->is_seen()) {
      if (track->moves_like(region, frame.interval_s)) {
        region_keys_[k] = track->key;
        continue;
      }
      track = nullptr;
    }
    if (!track || !track->is_confirmed()) {
      Track* back = region.blocks < kMinBlocks ? nullptr : expected_at(region, frame);
      // Noise does not move twice in the same way.
      if (back || (track && !track->moves_like(region, frame.interval_s))) track = back;
    }
    if (!is_enough(region, track, frame.field)) continue;
    if (!track) {
      region_keys_[k] = create(region);
      continue;
    }
    track->set_state(Track::State::kSeen);
    track->region = region;
    region_keys_[k] = track->key;
  }
}

/// Computes position and velocity in the frame from those of the region in the field's picture.
void ObjectTracker::position(Track& track, const FieldInFrame& frame) const {
  MovingObject& object = track.object;
  const Region& region = track.region;
  object.position_px = frame.scale * region.position_px + frame.offset_px;
  object.size_px = frame.scale * (region.high_px - region.low_px);
  object.low_off_px = frame.scale * (track.low_px - region.position_px) + object.size_px / 2;
  object.high_off_px = frame.scale * (track.high_px - region.position_px) - object.size_px / 2;
  object.area_px2 = frame.scale * frame.scale * region.blocks * kBlockArea_px;
  object.relative_px_s = frame.scale * track.velocity_px_s;
  object.on_screen_px_s =
      object.relative_px_s + frame.scale * region.background_px / frame.interval_s;
}

ObjectMotion ObjectTracker::measure(Track& track, const FieldInFrame& frame) {
  MovingObject& object = track.object;
  const ObjectMotion found = meter_.measure(track.key, track.region, evidence_in(frame));
  track.region.relative_px = found.relative_px;
  object.points = found.points;
  object.model = found.model.kind;
  update_rotation(track, found, frame);
  return found;
}

/// Chooses the objects whose rotation is measured: the felt one and, in turn, the one with the next
/// higher key.
void ObjectTracker::choose_turned(uint32_t felt) {
  felt_key_ = 0;
  uint32_t first = 0, next = 0;
  for (const Track& track : tracks_) {
    if (!track.is_seen() || !track.is_confirmed() || track.is_layer) continue;
    if (felt != 0 && track.object.id == felt) {
      felt_key_ = track.key;
      continue;
    }
    if (first == 0) first = track.key;
    if (next == 0 && track.key > turned_key_) next = track.key;
  }
  turned_key_ = next != 0 ? next : first;
}

/// Measures rotation and growth, unless the object cannot be felt: it is not confirmed yet, or is a
/// layer of the scene.
void ObjectTracker::update_rotation(Track& track, const ObjectMotion& found,
                                    const FieldInFrame& frame) {
  if (!track.is_confirmed() || track.is_layer) return track.miss_rotation(frame.interval_s);
  if (track.key != felt_key_ && track.key != turned_key_) return;
  const Turn as_before{track.roll.expected(frame.interval_s),
                       track.growth.expected(frame.interval_s)};
  const Turn turn = turns_.measure(track.key, track.region, found, as_before, evidence_in(frame));
  track.roll.update(turn.roll_rad, frame.interval_s);
  track.growth.update(turn.growth, frame.interval_s);
  track.object.roll_rad_s = track.roll.rate_1_s();
  track.object.growth_1_s = track.growth.rate_1_s();
}

/// The standard deviation of the motion of the blocks outside an object against the background, in
/// the direction in which the object moves. In a scene with depth, half of the picture may move
/// against any single model of the background; a region that does not stand out from this motion is
/// no object.
double ObjectTracker::noise_around(const Track& track) {
  // Where few blocks showed how the camera moves, those with texture may all be an object's rim.
  if (background_->is_of_few) return background_->sigma_px;
  around_px_.clear();
  for (size_t i = 0; i < owners_.size(); ++i) {
    const RelativeBlock& block = (*relative_)[i];
    if (owners_[i] == track.key || !block.shows_motion || block.was_outside ||
        moving_.burned_in().contains(i)) {
      continue;
    }
    around_px_.push_back(block.moved_px);
  }
  parallax_.measure(around_px_);
  return parallax_.sigma_px(track.region.relative_px);
}

/// Whether something else is in the place of most of an object: its visible part is a rim, and most
/// of the blocks of that part are not found in the picture before, so that their motions are
/// errors.
bool ObjectTracker::has_vanished(const Track& track, const FieldInFrame& frame) const {
  return track.is_rim(track.region) &&
         frame.field.are_lost([&](size_t block) { return owners_[block] == track.key; });
}

void ObjectTracker::observe(Track& track, const FieldInFrame& frame) {
  const ObjectMotion found = measure(track, frame);
  const Eigen::Vector2d velocity_px_s = has_vanished(track, frame)
                                            ? track.expected.velocity_px_s
                                            : track.region.relative_px / frame.interval_s;
  const bool is_new = track.blocks_seen == 0;
  if (is_new) track.velocity_px_s = velocity_px_s;
  // Smoothing removes motion within the error, and delays other motion by a frame or two.
  const double error_px = bound_.own_px(track.key, found, evidence_in(frame));
  const double news_px = (velocity_px_s - track.velocity_px_s).norm() * frame.interval_s;
  const double both_px2 = news_px * news_px + error_px * error_px;
  const double newest = both_px2 > 0 ? news_px * news_px / both_px2 : 1;
  track.velocity_px_s += newest * (velocity_px_s - track.velocity_px_s);
  const double late_px_s = (velocity_px_s - track.velocity_px_s).norm();
  track.expect(frame.interval_s);
  track.blocks_seen += std::min(track.region.blocks, Track::kConfirmBlocks - 1);
  track.object.has_left = false;
  if (is_new) {
    track.low_px = track.region.low_px;
    track.high_px = track.region.high_px;
  } else {
    track.move_box(frame.interval_s);
    track.draw_box_to(track.region, frame.interval_s);
  }
  position(track, frame);
  MovingObject& object = track.object;
  const double noise_px = camera_moves_ ? noise_around(track) : 0;
  track.evidence.add(track.region.relative_px, track.region.background_px, noise_px,
                     frame.interval_s);
  track.is_proven |= salience(track.region, track.evidence, camera_moves_, false) > 0;
  object.prominence = salience(track.region, track.evidence, camera_moves_, track.is_proven);
  track.is_layer = object.prominence == 0;
  if (!track.is_confirmed() || track.is_layer) return;
  const double most_px = bound_.px(track.key, track.region, found, evidence_in(frame));
  object.error_px_s = frame.scale * (most_px / frame.interval_s + late_px_s);
}

void ObjectTracker::observe_rest(Track& track, const FieldInFrame& frame) {
  for (size_t i = 0; i < owners_before_.size(); ++i) {
    const bool is_its = owners_before_[i] == track.key && finder_.labels()[i] == kNoRegion;
    if (is_its) owners_[i] = track.key;
  }
  track.expected.velocity_px_s.setZero();
  track.object.error_px_s = frame.scale * kErrorSigmas * background_->sigma_px / frame.interval_s;
}

/// Handles a frame in which nothing is known to move by itself at the object's position. The object
/// has come to rest if most of its usual blocks were there before. If only a rim was visible, the
/// object is invisible now and continues with its last motion.
void ObjectTracker::miss(Track& track, const FieldInFrame& frame) {
  MovingObject& object = track.object;
  if (track.since_s == 0) object.has_left = track.has_left(frame.interval_s);
  object.points = background_->is_known ? resting_blocks(track, frame.field).value_or(0) : 0;
  if (object.points > 0) {
    track.set_state(Track::State::kRests);
    observe_rest(track, frame);
  } else {
    track.set_state(Track::State::kHidden);
  }
  track.since_s += frame.interval_s;
  track.extrapolate(frame.interval_s);
  track.region.position_px = track.expected.position_px;
  track.velocity_px_s = track.expected.velocity_px_s;
  track.move_box(frame.interval_s);
  track.miss_rotation(frame.interval_s);
  object.prominence = 0;
  position(track, frame);
}

const std::vector<MovingObject>& ObjectTracker::update(const FieldInFrame& frame,
                                                       const Background& background,
                                                       uint32_t felt) {
  const BlockField& field = frame.field;
  const size_t n = field.blocks().size();
  if (owners_.size() != n) owners_.assign(n, 0);
  owners_before_.resize(n);
  expected_.resize(n);
  around_px_.reserve(n);
  for (size_t i = 0; i < n; ++i) {
    owners_before_[i] = owners_[field.origin_of(i)];
    const uint32_t owner = owners_before_[i];
    expected_[i] =
        owner != 0 && std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& track) {
          return track.key == owner && track.is_confirmed();
        });
  }
  background_ = &background;
  relative_ = &moving_.find(field, background, expected_);
  camera_moves_ = background.model.kind != ModelKind::kStill;

  if (moving_.burned_in().margins().have_changed()) {  // this changes what touches the border
    for (Track& track : tracks_) track.is_proven = false;
  }
  assign_regions(frame);
  for (size_t i = 0; i < n; ++i) {
    const int16_t label = finder_.labels()[i];
    owners_[i] = label == kNoRegion ? 0 : region_keys_[static_cast<size_t>(label)];
  }
  choose_turned(felt);
  for (Track& track : tracks_) {
    if (track.is_seen()) {
      observe(track, frame);
    } else {
      miss(track, frame);
    }
  }
  const auto is_over = [](const Track& track) {
    return (!track.is_confirmed() && !track.is_seen()) || track.since_s > kForgotten_s;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_over), tracks_.end());

  objects_.clear();
  for (Track& track : tracks_) {
    if (!track.is_confirmed() || track.is_layer) continue;
    if (track.object.id == 0) track.object.id = (*next_id_)++;
    objects_.push_back(track.object);
    if (track.state != Track::State::kHidden) continue;
    objects_.back().relative_px_s.setZero();
    objects_.back().on_screen_px_s.setZero();
  }
  std::sort(objects_.begin(), objects_.end(),
            [](const MovingObject& a, const MovingObject& b) { return a.id < b.id; });
  return objects_;
}

}  // namespace spidar
