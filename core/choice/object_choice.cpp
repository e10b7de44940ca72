// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/object_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spidar {
namespace {

/// An object that is found after a loss may be the lost one if its velocity differs from the former
/// one by less than this fraction of the larger speed.
constexpr double kSameVelocity = 0.5;

/// How well an object meets the rule. An object whose score is higher by 1 replaces another.
double score(const FeelRule& rule, const MovingObject& object, const ChoiceInput& frame) {
  if (rule.kind == FeelRule::Kind::kLargest) {
    return std::log(std::max(object.area_px2, 1.0)) / std::log(ObjectChoice::kLarger);
  }
  const Eigen::Vector2d direction = frame.turn.to_stored(rule.direction);
  return direction.dot(object.position_px) / (ObjectChoice::kFurther * frame.height());
}

/// Whether both rules mean the same object, which then need not be found again.
bool continues(const FeelRule& before, const FeelRule& now) {
  return before.kind == now.kind && before.kind != FeelRule::Kind::kBox &&
         before.from_ns == now.from_ns && before.position == now.position &&
         before.far_corner == now.far_corner && before.direction == now.direction;
}

}  // namespace

void BoxedObject::begin(const char* name) {
  *this = BoxedObject();
  name_ = name;
}

Chosen::State BoxedObject::state() const {
  if (has_found_ || waited_s_ <= kBoxTimeout_s) return Chosen::State::kGood;
  return has_box_ ? Chosen::State::kBoxAtRest : Chosen::State::kNoBox;
}

/// The visible object with the largest intersection over union with the box; null when none
/// overlaps the box enough.
const MovingObject* BoxedObject::at_box(const PictureBox& box, const ChoiceInput& frame) const {
  const Eigen::AlignedBox2d box_px = frame.px(box.position, box.far_corner);
  const double box_px2 = area_px2(box_px);
  const MovingObject* best = nullptr;
  double best_over_union = 0;
  for (const MovingObject& object : frame.objects) {
    if (object.points == 0) continue;
    const double overlap_px2 = area_px2(box_px.intersection(object.box_px()));
    const double object_px2 = object.size_px.prod();
    if (overlap_px2 <= 0 || overlap_px2 < kOverlap * std::min(box_px2, object_px2)) continue;
    const double over_union = overlap_px2 / (box_px2 + object_px2 - overlap_px2);
    if (over_union <= best_over_union) continue;
    best = &object;
    best_over_union = over_union;
  }
  return best;
}

const MovingObject* BoxedObject::update(const ChoiceInput& frame) {
  const MovingObject* best = nullptr;  // the same object, else the largest one
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
  return find_object(frame.objects, id_);
}

void FollowedObject::begin(const Eigen::Vector2d& position_px, double since_s) {
  *this = FollowedObject();
  state_ = State::kSearching;
  position_px_ = position_px;
  since_s_ = since_s;
}

/// Whether an object at the position may be the wanted one.
bool FollowedObject::may_be(const MovingObject& object) const {
  if (object.points == 0) return false;
  if (state_ == State::kSearching) return true;
  const uint32_t* const end = before_.data() + before_count_;
  if (std::find(before_.data(), end, object.id) != end) return false;
  if (state_ != State::kFollowed) return true;
  const double faster_px_s = std::max(object.relative_px_s.norm(), velocity_px_s_.norm());
  return (object.relative_px_s - velocity_px_s_).norm() < kSameVelocity * faster_px_s;
}

/// Returns the candidate whose box is nearest to the position, the smallest one if several boxes
/// are equally near; null if none is within reach. In kSearching, boxes are moved back in time to
/// where they were at begin().
const MovingObject* FollowedObject::at_position(const std::vector<MovingObject>& objects,
                                                double reach_px) const {
  const MovingObject* best = nullptr;
  double nearest_px = reach_px;
  for (const MovingObject& object : objects) {
    if (!may_be(object)) continue;
    const double back_s = state_ == State::kSearching ? since_s_ : 0;
    const Eigen::AlignedBox2d was_px = object.box_px().translated(-back_s * object.relative_px_s);
    const double distance_px = was_px.exteriorDistance(position_px_);
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
  position_px_ = object.position_px;
  velocity_px_s_ = object.relative_px_s;
  hidden_ = object.points == 0;
  rested_ = !hidden_ && object.relative_px_s.isZero(0);
}

/// Handles a frame without the object.
void FollowedObject::miss(double interval_s) {
  missing_s_ += interval_s;
  if (rested_) {
    state_ = State::kResting;
  } else if (missing_s_ > kLost_s) {
    state_ = State::kLost;
  }
}

const MovingObject* FollowedObject::update(const std::vector<MovingObject>& objects,
                                           int frame_height, double interval_s,
                                           const Background* background) {
  const MovingObject* found = find_object(objects, id_);
  if (!found) {
    if (id_ != 0 && state_ != State::kLost) miss(interval_s);
    if (state_ == State::kSearching && since_s_ > kSearch_s) state_ = State::kWaiting;
    if (background && !is_first_) position_px_ += background->model.displacement_px(position_px_);
    position_px_ += velocity_px_s_ * interval_s;
    const bool is_gone = state_ == State::kFollowed && (hidden_ || missing_s_ > kSearch_s);
    if (state_ != State::kLost && !is_gone) {
      found = at_position(objects, kReach * frame_height);
    }
  }
  if (found) follow(*found);
  is_first_ = false;
  since_s_ += interval_s;
  before_count_ = std::min(objects.size(), before_.size());
  for (size_t i = 0; i < before_count_; ++i) before_[i] = objects[i].id;
  return found;
}

void ObjectChoice::set_rules(std::shared_ptr<const FeelRules> rules) {
  if (rules == rules_) return;
  const FeelRule* going_on = nullptr;
  for (size_t i = 0; rule_ && rules && i < rules->rules().size(); ++i) {
    if (continues(*rule_, rules->rules()[i])) going_on = &rules->rules()[i];
  }
  rule_ = going_on;
  rules_ = std::move(rules);
}

void ObjectChoice::set_kept(const KeptObject& kept) {
  kept_ = kept;
}

void ObjectChoice::reset() {
  rule_ = nullptr;
  clicked_ = FollowedObject();
}

/// Chooses among the visible objects. The felt object stays until another one is clearly better.
const MovingObject* ObjectChoice::best(const FeelRule& rule, const ChoiceInput& frame) {
  const MovingObject* now = nullptr;
  const MovingObject* other = nullptr;
  for (const MovingObject& object : frame.objects) {
    if (object.id == best_) now = &object;
    if (object.points == 0) continue;
    if (!other || score(rule, object, frame) > score(rule, *other, frame)) other = &object;
  }
  best_missing_s_ = now && now->points > 0 ? 0 : best_missing_s_ + frame.interval_s;
  const bool holds = best_ != 0 && best_missing_s_ <= kHold_s &&
                     (!now || !other || score(rule, *other, frame) < score(rule, *now, frame) + 1);
  if (holds) return now;
  best_ = other ? other->id : 0;
  best_missing_s_ = 0;
  return other;
}

/// Begins a rule with this frame.
void ObjectChoice::begin(const FeelRule& rule, const ChoiceInput& frame) {
  rule_ = &rule;
  best_ = 0;
  missed_ = false;
  const double since_s = static_cast<double>(frame.stream_ns - rule.from_ns) * 1e-9;
  seen_from_begin_ = since_s <= FollowedObject::kSearch_s;
  ruled_.begin(frame.px(rule.position), since_s);
  boxed_.begin(rule.name.data());
}

/// Chooses the object that was at the position of the rule when the rule began.
void ObjectChoice::by_position(const ChoiceInput& frame, Chosen& choice) {
  if (!seen_from_begin_) {
    choice.state = Chosen::State::kNotSeen;
    return;
  }
  choice.object = ruled_.update(frame.objects, frame.height(), frame.interval_s, frame.background);
  missed_ |= ruled_.state() == FollowedObject::State::kWaiting;
  if (missed_) choice.state = Chosen::State::kNotThere;
  if (ruled_.state() == FollowedObject::State::kLost) choice.state = Chosen::State::kLost;
}

void ObjectChoice::by_rule(const FeelRule& rule, const ChoiceInput& frame, Chosen& choice) {
  using Kind = FeelRule::Kind;
  if (rule_ != &rule) begin(rule, frame);
  choice.rule = rule;
  if (rule.kind == Kind::kLargest || rule.kind == Kind::kFurthest) {
    choice.object = best(rule, frame);
  } else if (rule.kind == Kind::kBox) {
    choice.object = boxed_.update(frame);
    choice.state = boxed_.state();
  } else if (rule.kind == Kind::kObjectAt) {
    by_position(frame, choice);
  }
}

/// Returns false if there is no click, or while its object is still being searched for.
bool ObjectChoice::follow_click(const ChoiceInput& frame, Chosen& choice) {
  if (kept_.click == 0) return false;
  if (followed_click_ != kept_.click) {
    followed_click_ = kept_.click;
    clicked_.begin(frame.px(kept_.position), 0);
  }
  const MovingObject* const object =
      clicked_.update(frame.objects, frame.height(), frame.interval_s, frame.background);
  const FollowedObject::State state = clicked_.state();
  if (state == FollowedObject::State::kSearching) return false;
  choice.is_kept = true;
  choice.object = object;
  if (state == FollowedObject::State::kWaiting) choice.state = Chosen::State::kNotThere;
  if (state == FollowedObject::State::kLost) choice.state = Chosen::State::kLost;
  return true;
}

Chosen ObjectChoice::choose(const ChoiceInput& frame) {
  if (frame.is_cut) {
    ruled_.cut();
    boxed_.cut();
    clicked_.cut();
    best_ = 0;
  }
  const FeelRule* const rule = rules_ ? rules_->at(frame.stream_ns) : nullptr;
  Chosen by_rules;
  if (rule) {
    by_rule(*rule, frame, by_rules);
  } else {
    rule_ = nullptr;
  }
  Chosen by_click;
  return follow_click(frame, by_click) ? by_click : by_rules;
}

}  // namespace spidar
