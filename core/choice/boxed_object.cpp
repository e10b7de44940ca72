// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/boxed_object.h"

#include <algorithm>

namespace spidar {
namespace {

double area_px2(const Eigen::Vector2d& size_px) {
  return size_px.cwiseMax(0.0).prod();
}

}  // namespace

void BoxedObject::begin(const char* name) {
  *this = BoxedObject();
  name_ = name;
}

ChoiceState BoxedObject::state() const {
  if (has_found_ || waited_s_ <= kPatience_s) return ChoiceState::kGood;
  return has_box_ ? ChoiceState::kBoxAtRest : ChoiceState::kNoBox;
}

/// The object in sight that has most in common with the box for their size; null when that is not
/// enough.
const MovingObject* BoxedObject::at_box(const PictureBox& box, const ChoiceFrame& frame) const {
  const Eigen::Vector2d a_px = frame.px(box.place), b_px = frame.px(box.far_corner);
  const Eigen::Vector2d from_px = a_px.cwiseMin(b_px), to_px = a_px.cwiseMax(b_px);
  const double box_px2 = area_px2(to_px - from_px);
  const MovingObject* best = nullptr;
  double best_share = 0;
  for (const MovingObject& object : frame.objects) {
    if (object.tracks == 0) continue;
    const Eigen::Vector2d half_px = object.size_px / 2;
    const double common_px2 = area_px2(to_px.cwiseMin(object.position_px + half_px) -
                                       from_px.cwiseMax(object.position_px - half_px));
    const double object_px2 = area_px2(object.size_px);
    if (common_px2 <= 0 || common_px2 < kOverlap * std::min(box_px2, object_px2)) continue;
    const double share = common_px2 / (box_px2 + object_px2 - common_px2);
    if (share <= best_share) continue;
    best = &object;
    best_share = share;
  }
  return best;
}

const MovingObject* BoxedObject::see(const ChoiceFrame& frame) {
  const MovingObject* best = nullptr;  // the object itself, else the largest one
  missing_s_ += frame.interval_s;
  waited_s_ += frame.interval_s;
  const bool holds = id_ != 0 && missing_s_ <= kHold_s;
  for (size_t i = 0; frame.boxes && i < frame.boxes->size(); ++i) {
    const PictureBox& box = (*frame.boxes)[i];
    if (name_[0] && box.name != name_) continue;
    has_box_ = true;
    const MovingObject* const object = at_box(box, frame);
    if (!object) continue;
    const bool is_same = object->id == id_;
    if (!is_same && (holds || (best && object->area_px2 <= best->area_px2))) continue;
    best = object;
    if (is_same) break;
  }
  if (best) {
    id_ = best->id;
    missing_s_ = 0;
    has_found_ = true;
    return best;
  }
  if (!holds) return nullptr;
  const auto known = std::find_if(frame.objects.begin(), frame.objects.end(),
                                  [&](const MovingObject& object) { return object.id == id_; });
  return known == frame.objects.end() ? nullptr : &*known;
}

}  // namespace spidar
