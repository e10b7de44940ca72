// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/objects/dominant_object.h"

#include <algorithm>
#include <utility>
namespace spidar {
namespace {

/// Memory for the objects of a frame, see ObjectTracker::kMaxObjects.
constexpr size_t kMaxRivals = 16;

/// The rate at which the reason for a rival grows when the present object has been followed for
/// `followed_s`, see DominantObject.
double growth(double prominence, double of_followed, double followed_s) {
  if (prominence == 0) return -1;
  const double settled = std::min(1.0, followed_s / DominantObject::kSettles_s);
  const double claim = (1 + settled * (DominantObject::kClearly - 1)) * of_followed;
  return (prominence - claim) / (prominence + claim);
}

/// Two boxes are of one object if they share more than this fraction of the smaller box.
constexpr double kSamePlace = 0.5;

/// Whether an object is where an invisible one would be: both are then parts of the same object.
bool has_replaced(const MovingObject& object, const MovingObject& hidden) {
  return area_px2(object.box_px().intersection(hidden.box_px())) >
         kSamePlace * std::min(object.size_px.prod(), hidden.size_px.prod());
}

}  // namespace

/// Whether an object is new since the followed one was last seen, and is where the followed one may
/// have gone, in any direction.
bool DominantObject::may_be_it(const MovingObject& object) const {
  if (object.id <= newest_id_) return false;
  return last_box_px_.intersects(object.box_px());
}

DominantObject::DominantObject() {
  rivals_.reserve(kMaxRivals);
  next_.reserve(kMaxRivals);
}

void DominantObject::reset() {
  id_ = 0;
  lost_s_ = followed_s_ = 0;
  rivals_.clear();
}

double DominantObject::reason_before(uint32_t id) const {
  const auto known = std::find_if(rivals_.begin(), rivals_.end(),
                                  [id](const Rival& rival) { return rival.id == id; });
  return known == rivals_.end() ? lost_s_ / 2 : known->reason_s;
}

const MovingObject* DominantObject::choose(const std::vector<MovingObject>& objects,
                                           double interval_s) {
  const MovingObject* const followed = find_object(objects, id_);
  // Objects that leave the picture are dropped.
  const bool is_free = id_ == 0 || (followed && followed->has_left);
  const bool in_sight = followed && followed->points > 0 && !is_free;
  if (in_sight) {
    lost_s_ = 0;
    followed_s_ += interval_s;
    last_box_px_ = followed->box_px();
    last_speed_px_s_ = followed->on_screen_px_s.norm();
    newest_id_ = objects.back().id;
  } else {
    const Eigen::Vector2d reach_px = Eigen::Vector2d::Constant(last_speed_px_s_ * interval_s);
    last_box_px_ = {last_box_px_.min() - reach_px, last_box_px_.max() + reach_px};
  }
  // A rival takes over in the frame nearest to the time at which its reason reaches kReason_s.
  const double enough_s = std::max(0.0, kReason_s - interval_s / 2);
  const double least_s = in_sight ? -kReason_s : 0;
  const MovingObject* best = nullptr;
  next_.clear();
  for (const MovingObject& object : objects) {
    if (&object == followed) continue;
    const double more_s =
        interval_s * growth(object.prominence, in_sight ? followed->prominence : 0, followed_s_);
    const double reason_s = std::max(least_s, std::max(least_s, reason_before(object.id)) + more_s);
    next_.push_back({object.id, reason_s});
    const bool continues =
        followed && followed->points == 0 && (has_replaced(object, *followed) || may_be_it(object));
    const bool may_take_over = is_free || continues || reason_s > enough_s;
    if (object.prominence == 0 || !may_take_over) continue;
    if (!best || object.prominence > best->prominence) best = &object;
  }
  std::swap(rivals_, next_);
  if (!in_sight) lost_s_ += interval_s;
  if (!best) return followed;
  id_ = best->id;
  lost_s_ = followed_s_ = 0;
  rivals_.clear();
  return best;
}

}  // namespace spidar
