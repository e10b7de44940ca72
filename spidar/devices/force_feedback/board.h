// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback joysticks, wheels and gamepads of Linux: up to two force axes and a position.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/grip/string_geometry.h"
#include "spidar/devices/force_feedback/stick_effects.h"
#include "spidar/link/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/text.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

/// A stick that is pushed all the way corresponds to a grip half way from the middle to the string
/// exits of the profile, which is the edge of the picture for pointer=grip.
class ForceFeedback final : public ForceBoard {
 public:
  static constexpr int kUpdate_ms = StickEffects::kUpdate_ms;
  ForceFeedback(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
                StickEffects::Updates updates, const StickEffects::Options& options = {})
      : ForceBoard(std::move(name)),
        reach_m_(half_picture_m(profile.geometry)),
        effects_(std::make_shared<StickEffects>(name_, std::move(transport), updates, options)) {}
  ~ForceFeedback() override { effects_->close(false); }

  void open() override {
    effects_->open();
    reopening_ = false;
    const ff::Description& found = effects_->description();
    force_axes_ = effects_->effects() > 1 ? 2 : found.constant;
    position_axes_ = found.axes;
    buttons_ = found.buttons;
  }
  LinkFault cycle(const ForceOutput& output, ForceReading& reading, int64_t) noexcept override {
    const LinkFault fault = effects_->cycle(output.force_N.head<2>(), pulls(output));
    if (fault != LinkFault::kNone) return fault;
    reading.position_m.head<2>() = reach_m_.cwiseProduct(effects_->position());
    reading.buttons = effects_->buttons();
    return LinkFault::kNone;
  }
  /// The thread that makes the updates recovers from faults.
  void recover() noexcept override {}
  /// Before a reopening, the centring spring stays off for the hand that still holds the stick.
  void close() noexcept override { effects_->close(reopening_); }
  std::vector<LastWill> last_wills() const override { return effects_->last_wills(); }
  /// Also names what the device lacks.
  std::string description() const override {
    const ff::Description& found = effects_->description();
    std::string text = found.name.data();
    const double gain = effects_->gain();
    if (gain < 1) text += formatted(" at %.0f %% of its strength", 100 * gain);
    if (!found.constant) {
      return text + ", rumble only: the strength of the force is felt, not its direction";
    }
    text += force_axes_ > 1 ? ", force feedback on two axes" : ", force feedback on one axis";
    if (found.axes_by_id) text += ", as its USB ID says";
    if (force_axes_ < 2) text += ": forces up and down are not felt";
    return found.autocentre ? text : text + "; its driver cannot switch a centring spring off";
  }
  GripAbilities abilities() const noexcept override {
    const int force = force_axes_, position = position_axes_;
    return {.force = {true, force != 1, false},
            .torque = false,
            .direction = force != 0,
            .position = {position > 0, position > 1, false},
            .largest_force_N = ff::kFullForce_N,
            .rate_Hz = 1000 / kUpdate_ms,
            .buttons = buttons_};
  }

 private:
  const Eigen::Vector2d reach_m_;  ///< range of the stick, to the right and up
  const std::shared_ptr<StickEffects> effects_;
  std::atomic<int> force_axes_{2};     ///< 1: only x; 0: the device only rumbles
  std::atomic<int> position_axes_{2};  ///< 1: only x
  std::atomic<int> buttons_{0};
};

}  // namespace spidar::boards
