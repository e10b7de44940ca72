// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a person wants to feel of a frame, by rules or by a click.
#pragma once

#include <cstdint>
#include <memory>

#include "core/choice/boxed_object.h"
#include "core/choice/chosen.h"
#include "core/choice/feel_rules.h"
#include "core/choice/followed_object.h"
#include "core/motion/objects/moving_object.h"

namespace spidar {

/// Frames in the order in which they are shown. Allocates nothing.
class ObjectChoice {
 public:
  /// A rule that is among them as before goes on with its object.
  void set_rules(std::shared_ptr<const FeelRules> rules);
  void set_kept(const KeptObject& kept);

  /// The result points into `frame`.
  Chosen choose(const ChoiceFrame& frame);

  /// Objects are others now: after a seek.
  void reset();

  /// How much more than the one that is felt another object must have of what counts: 1.3 times the
  /// area, or a twentieth of the frame's height further to the side.
  static constexpr double kLarger = 1.3;
  static constexpr double kFurther = 0.05;
  /// One that is not among the objects for so long is given up.
  static constexpr double kHold_s = 0.2;

 private:
  void by_rule(const FeelRule& rule, const ChoiceFrame& frame, Chosen& choice);
  const MovingObject* best(const FeelRule& rule, const ChoiceFrame& frame);
  bool follow_click(const ChoiceFrame& frame, Chosen& choice);

  std::shared_ptr<const FeelRules> rules_;
  const FeelRule* rule_ = nullptr;  ///< of the frame before
  bool seen_from_begin_ = false;    ///< the rule, see ChoiceState::kNotSeen
  FollowedObject ruled_;
  bool missed_ = false;  ///< nothing was at the place of `ruled_`
  BoxedObject boxed_;
  uint32_t best_ = 0;  ///< of kLargest and kFurthest
  double best_missing_s_ = 0;

  KeptObject kept_;
  uint32_t followed_click_ = 0;
  FollowedObject clicked_;
};

}  // namespace spidar
