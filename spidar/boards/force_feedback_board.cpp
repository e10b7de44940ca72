// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/force_feedback_board.h"

#include <cstdio>
#include <utility>

#include "core/grip/picture_size.h"

namespace spidar {

ForceFeedbackBoard::ForceFeedbackBoard(std::string name, const Profile& profile,
                                       std::unique_ptr<Transport> transport, Updates updates,
                                       const StickEffects::Options& options)
    : name_(std::move(name)),
      reach_m_(half_picture_m(profile.geometry)),
      effects_(std::make_shared<StickEffects>(name_, std::move(transport), updates, options)) {}

LinkFault ForceFeedbackBoard::cycle(const ForceOutput& output, ForceReading& reading,
                                    int64_t) noexcept {
  const LinkFault fault = effects_->cycle(output.force_N.head<2>(), pulls(output));
  if (fault != LinkFault::kNone) return fault;
  reading.position_m.head<2>() = reach_m_.cwiseProduct(effects_->place());
  reading.buttons = effects_->buttons();
  return LinkFault::kNone;
}

void ForceFeedbackBoard::open() {
  reopening_ = false;
  effects_->open();
  const ff::Description& found = effects_->description();
  force_axes_ = effects_->effects() > 1 ? 2 : found.constant;
  position_axes_ = found.axes;
  buttons_ = found.buttons;
}

GripAbilities ForceFeedbackBoard::abilities() const noexcept {
  const int force = force_axes_, position = position_axes_;
  return {{true, force != 1, false},
          false,
          force != 0,
          {position > 0, position > 1, false},
          ff::kFullForce_N,
          1000 / kUpdate_ms,
          buttons_};
}

std::string ForceFeedbackBoard::description() const {
  const ff::Description& found = effects_->description();
  std::string text = found.name.data();
  if (effects_->gain() < 1) {
    char share[40];
    std::snprintf(share, sizeof share, " at %.0f %% of its strength", 100 * effects_->gain());
    text += share;
  }
  if (!found.constant)
    return text + ", rumble only: the strength of the force is felt, not its direction";
  if (force_axes_ > 1) return text + ", force feedback on two axes";
  return text + ", force feedback on one axis: forces up and down are not felt";
}

}  // namespace spidar
