// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/force_feedback_board.h"

#include <cstdio>
#include <utility>

namespace spidar {
namespace {

/// Full deflection of the stick, as a share of the distance from the centre to the strings' exits.
constexpr double kReach = 0.5;

}  // namespace

ForceFeedbackBoard::ForceFeedbackBoard(std::string name, const Profile& profile,
                                       std::unique_ptr<Transport> transport, Updates updates,
                                       const StickEffects::Options& options)
    : name_(std::move(name)),
      effects_(std::make_shared<StickEffects>(name_, std::move(transport), updates, options)) {
  for (int i = 0; i < profile.geometry.count; ++i)
    reach_m_ = reach_m_.cwiseMax(
        kReach * profile.geometry.exit_m[static_cast<size_t>(i)].head<2>().cwiseAbs());
}

LinkFault ForceFeedbackBoard::cycle(const ForceOutput& output, ForceReading& reading,
                                    int64_t) noexcept {
  const LinkFault fault = effects_->cycle(output.force_N.head<2>(), pulls(output));
  if (fault != LinkFault::kNone) return fault;
  reading.position_m.head<2>() = reach_m_.cwiseProduct(effects_->place());
  return LinkFault::kNone;
}

void ForceFeedbackBoard::open() {
  reopening_ = false;
  effects_->open();
  const ff::Description& found = effects_->description();
  force_axes_ = effects_->effects() > 1 ? 2 : found.constant;
  position_axes_ = found.axes;
}

GripAbilities ForceFeedbackBoard::abilities() const noexcept {
  const int force = force_axes_, position = position_axes_;
  return {{true, force != 1, false},
          false,
          force != 0,
          {position > 0, position > 1, false},
          ff::kFullForce_N,
          1000 / kUpdate_ms};
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
