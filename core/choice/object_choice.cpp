// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/object_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spidar {
namespace {

/// How well an object meets the rule, so that one that does so by 1 more takes the other's place.
double score(const FeelRule& rule, const MovingObject& object, const ChoiceFrame& frame) {
  if (rule.kind == FeelKind::kLargest) {
    return std::log(std::max(object.area_px2, 1.0)) / std::log(ObjectChoice::kLarger);
  }
  const Eigen::Vector2d direction = frame.film.turn.to_coded(rule.direction);
  return direction.dot(object.position_px) / (ObjectChoice::kFurther * frame.height);
}

/// Whether `now` is the rule `before` in other words, so that its object need not be found anew.
bool goes_on(const FeelRule& before, const FeelRule& now) {
  return before.kind == now.kind && before.kind != FeelKind::kBox &&
         before.from_ns == now.from_ns && before.place == now.place &&
         before.far_corner == now.far_corner && before.direction == now.direction;
}

}  // namespace

void ObjectChoice::set_rules(std::shared_ptr<const FeelRules> rules) {
  if (rules == rules_) return;
  const FeelRule* going_on = nullptr;
  for (size_t i = 0; rule_ && rules && i < rules->rules().size(); ++i) {
    if (goes_on(*rule_, rules->rules()[i])) going_on = &rules->rules()[i];
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

/// Chooses among the objects in sight. The one that is felt stays until another one is clearly
/// better.
const MovingObject* ObjectChoice::best(const FeelRule& rule, const ChoiceFrame& frame) {
  const MovingObject* now = nullptr;
  const MovingObject* other = nullptr;
  for (const MovingObject& object : frame.objects) {
    if (object.id == best_) now = &object;
    if (object.tracks == 0) continue;
    if (!other || score(rule, object, frame) > score(rule, *other, frame)) other = &object;
  }
  best_missing_s_ = now && now->tracks > 0 ? 0 : best_missing_s_ + frame.interval_s;
  const bool holds = best_ != 0 && best_missing_s_ <= kHold_s &&
                     (!now || !other || score(rule, *other, frame) < score(rule, *now, frame) + 1);
  if (holds) return now;
  best_ = other ? other->id : 0;
  best_missing_s_ = 0;
  return other;
}

void ObjectChoice::by_rule(const FeelRule& rule, const ChoiceFrame& frame, Chosen& choice) {
  choice.rule = rule;
  if (rule_ != &rule) {
    rule_ = &rule;
    best_ = 0;
    missed_ = false;
    const double since_s = static_cast<double>(frame.film.stream_ns - rule.from_ns) * 1e-9;
    seen_from_begin_ = since_s <= FollowedObject::kLook_s;
    ruled_.begin(frame.px(rule.place), since_s);
    boxed_.begin(rule.name.data());
  }
  if (rule.kind == FeelKind::kLargest || rule.kind == FeelKind::kFurthest) {
    choice.object = best(rule, frame);
  } else if (rule.kind == FeelKind::kBox) {
    choice.object = boxed_.see(frame);
    choice.state = boxed_.state();
  } else if (rule.kind == FeelKind::kObjectAt && !seen_from_begin_) {
    choice.state = ChoiceState::kNotSeen;
  } else if (rule.kind == FeelKind::kObjectAt) {
    choice.object = ruled_.see(frame.objects, frame.height, frame.interval_s, frame.background);
    missed_ |= ruled_.state() == FollowedObject::State::kWaiting;
    if (ruled_.state() == FollowedObject::State::kLost) {
      choice.state = ChoiceState::kLost;
    } else if (missed_) {
      choice.state = ChoiceState::kNotThere;
    }
  }
}

/// False when no click counts, or not yet.
bool ObjectChoice::follow_click(const ChoiceFrame& frame, Chosen& choice) {
  if (kept_.click == 0) return false;
  if (followed_click_ != kept_.click) {
    followed_click_ = kept_.click;
    clicked_.begin(frame.px(kept_.place), 0);
  }
  const MovingObject* const object =
      clicked_.see(frame.objects, frame.height, frame.interval_s, frame.background);
  const FollowedObject::State state = clicked_.state();
  if (state == FollowedObject::State::kLooking) return false;
  choice.is_kept = true;
  choice.object = object;
  if (state == FollowedObject::State::kWaiting) choice.state = ChoiceState::kNotThere;
  if (state == FollowedObject::State::kLost) choice.state = ChoiceState::kLost;
  return true;
}

Chosen ObjectChoice::choose(const ChoiceFrame& frame) {
  if (frame.is_cut) {
    ruled_.cut();
    boxed_.cut();
    clicked_.cut();
    best_ = 0;
  }
  const FeelRule* const rule = rules_ ? rules_->at(frame.film.stream_ns) : nullptr;
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
