// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "spidar/grip/grip.h"
#include "spidar/grip/pose_trust.h"
#include "spidar/grip/reading_gate.h"
#include "spidar/link/board.h"
#include "spidar/link/link_thread.h"
#include "spidar/profiles/profile.h"

namespace spidar::boards {

/// The grip of a device that takes a force directly, not as tensions of strings. Sends the force to
/// the board in the axes that the board renders, up to its range, and reads the position from the
/// board. There is no torque, and no rotation.
class ForceGrip final : public Grip {
 public:
  explicit ForceGrip(std::unique_ptr<ForceLink> link)
      : Grip(*link), link_(std::move(link)), traits_(traits_of(link_->board().abilities())) {}

  void open() override {
    link_->open();
    trust_ = {};
    gate_.reset();
    reading_.delivered = {};
    reading_.pose = {};
    reading_.motion.reset();
    reading_.pose_fault = trust_.fault();
  }
  void check_age(int64_t now_ns) noexcept override {
    trust_.check_age(now_ns);
    reading_.pose_fault = trust_.fault();
  }
  LinkFault exchange(const GripCommand& command) noexcept override {
    const ForceOutput output = output_for(command);
    ForceReading answer;
    const LinkFault fault = link_->exchange(output, answer);
    if (fault == LinkFault::kNone) {
      reading_.delivered.force_N = output.force_N;
      update(answer, command);
    } else {
      // The device may not have received the command of this tick.
      trust_.miss(command.now_ns);
      if (!trust_.trusted()) reading_.motion.reset();
    }
    reading_.pose_fault = trust_.fault();
    return fault;
  }
  const GripReading& reading() const noexcept override { return reading_; }
  const GripTraits& traits() const noexcept override { return traits_; }
  GripAbilities abilities() const noexcept override { return link_->board().abilities(); }
  std::string warning() const override { return link_->board().warning(); }

 private:
  /// A grip that is free in all axes flies when a hand releases it; a stick does not. The device
  /// renders no torques, and the lag of its drives is unknown.
  static GripTraits traits_of(const GripAbilities& can) noexcept {
    const std::array<bool, 3> all{true, true, true};
    const bool free = can.direction && can.force == all && can.position == all;
    return {false, free, 0, free ? Profile::kDriveLag_s : 0};
  }
  ForceOutput output_for(const GripCommand& command) const noexcept {
    const GripAbilities can = link_->board().abilities();
    ForceOutput output;
    output.on = command.power > 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (can.force[static_cast<size_t>(axis)]) {
        output.force_N[axis] = command.power * command.wrench.force_N[axis];
      }
    }
    const double wanted_N = output.force_N.norm();
    if (wanted_N > can.largest_force_N) output.force_N *= can.largest_force_N / wanted_N;
    return output;
  }
  void update(const ForceReading& answer, const GripCommand& command) noexcept {
    reading_.buttons = answer.buttons;
    reading_.lag_ns = answer.lag_ns;
    const int64_t read_ns = PoseTrust::time_of(answer.read_ns, command.now_ns);
    const PoseFault fault = judge(answer, read_ns);
    const bool known = fault == PoseFault::kNone || fault == PoseFault::kJump;
    if (traits_.can_fly && known && !gate_.accept(answer.position_m, read_ns)) {
      ++reading_.pose_errors;
      return trust_.fail(PoseFault::kJump);
    }
    if (known) {
      reading_.pose.position_m = answer.position_m;
      trust_.locate(read_ns);
    }
    if (fault == PoseFault::kNone) {
      trust_.succeed(command.wrench.stacked().isZero(0));
    } else {
      ++reading_.pose_errors;
      trust_.fail(fault, fault == PoseFault::kJump);
    }
    if (trust_.trusted()) {
      reading_.motion.update(reading_.pose, trust_.located_ns());
    } else {
      reading_.motion.reset();
    }
  }
  /// Jumps of a stick are no faults: it snaps back when released, and its driver seldom reports.
  PoseFault judge(const ForceReading& answer, int64_t read_ns) const noexcept {
    if (!answer.position_m.allFinite()) return answer.pose_fault;
    const double moved_m = (answer.position_m - reading_.pose.position_m).norm();
    return traits_.can_fly && trust_.is_jump(moved_m, read_ns) ? PoseFault::kJump
                                                               : PoseFault::kNone;
  }

  /// More than one count of the coarsest device: 38 µm at the arm of the Falcon.
  static constexpr double kPositionError_m = 50e-6;

  const std::unique_ptr<ForceLink> link_;
  const GripTraits traits_;
  GripReading reading_;
  ReadingGate<3> gate_{kPositionError_m};
  PoseTrust trust_;
};

}  // namespace spidar::boards
