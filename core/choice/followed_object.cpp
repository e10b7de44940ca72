// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/followed_object.h"

#include <algorithm>

namespace spidar {
namespace {

/// Motions of an object before and after differ by less than this share of the faster one.
constexpr double kSameVelocity = 0.5;

}  // namespace

void FollowedObject::begin(const Eigen::Vector2d& place_px, double since_s) {
  *this = FollowedObject();
  state_ = State::kLooking;
  place_px_ = place_px;
  since_s_ = since_s;
}

/// Whether an object at the place may be the one that is looked for.
bool FollowedObject::may_be(const MovingObject& object) const {
  if (object.tracks == 0) return false;
  if (state_ == State::kLooking) return true;
  const uint32_t* const end = before_.data() + before_count_;
  if (std::find(before_.data(), end, object.id) != end) return false;
  if (state_ != State::kFollowed) return true;
  const double faster_px_s = std::max(object.relative_px_s.norm(), velocity_px_s_.norm());
  return (object.relative_px_s - velocity_px_s_).norm() < kSameVelocity * faster_px_s;
}

/// The object that it may be and whose box is nearest to the place, the smallest one if there are
/// several; null when none is within reach. While it is looked for, objects are taken back to where
/// they were at begin().
const MovingObject* FollowedObject::at_place(const std::vector<MovingObject>& objects,
                                             double reach_px) const {
  const MovingObject* best = nullptr;
  double nearest_px = reach_px;
  for (const MovingObject& object : objects) {
    if (!may_be(object)) continue;
    const double back_s = state_ == State::kLooking ? since_s_ : 0;
    const Eigen::Vector2d was_px = object.position_px - back_s * object.relative_px_s;
    const Eigen::Vector2d outside_px =
        ((place_px_ - was_px).cwiseAbs() - object.size_px / 2).cwiseMax(0.0);
    const double distance_px = outside_px.norm();
    const bool is_better =
        distance_px < nearest_px ||
        (distance_px == nearest_px && (!best || object.area_px2 < best->area_px2));
    if (!is_better) continue;
    best = &object;
    nearest_px = distance_px;
  }
  return best;
}

void FollowedObject::follow(const MovingObject& object) {
  state_ = State::kFollowed;
  id_ = object.id;
  missing_s_ = 0;
  place_px_ = object.position_px;
  velocity_px_s_ = object.relative_px_s;
  hidden_ = object.tracks == 0;
  rested_ = !hidden_ && object.relative_px_s.isZero(0);
}

/// It is not among the objects of this frame.
void FollowedObject::miss(double interval_s) {
  missing_s_ += interval_s;
  if (rested_) {
    state_ = State::kResting;
  } else if (missing_s_ > kLost_s) {
    state_ = State::kLost;
  }
}

const MovingObject* FollowedObject::see(const std::vector<MovingObject>& objects, int frame_height,
                                        double interval_s, const Background* background) {
  const auto known = std::find_if(objects.begin(), objects.end(), [&](const MovingObject& object) {
    return id_ != 0 && object.id == id_;
  });
  const MovingObject* found = known != objects.end() ? &*known : nullptr;
  if (!found) {
    if (id_ != 0 && state_ != State::kLost) miss(interval_s);
    if (state_ == State::kLooking && since_s_ > kLook_s) state_ = State::kWaiting;
    if (background && !is_first_) place_px_ += background->model.displacement_px(place_px_);
    place_px_ += velocity_px_s_ * interval_s;
    const bool is_gone = state_ == State::kFollowed && (hidden_ || missing_s_ > kLook_s);
    if (state_ != State::kLost && !is_gone) {
      found = at_place(objects, kReach * frame_height);
    }
  }
  if (found) follow(*found);
  is_first_ = false;
  since_s_ += interval_s;
  before_count_ = std::min(objects.size(), before_.size());
  for (size_t i = 0; i < before_count_; ++i) before_[i] = objects[i].id;
  return found;
}

}  // namespace spidar
