// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A grip without strings: takes a force in three axes, and is where a test puts it.
#pragma once

#include <string>
#include <vector>

#include "spidar/grip/grip.h"

namespace spidar::test {

class FakeGrip final : public Grip {
 public:
  // Set by the test.
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  bool known = true;
  ExchangeStatus answer = ExchangeStatus::kOk;
  bool present = true;
  // Seen by the test.
  std::vector<GripCommand> commands;
  bool is_open = false;

  explicit FakeGrip(bool can_fly) : traits_{false, can_fly, 0, 0} {}

  void open() override {
    if (!present) throw DeviceError("fake: not there");
    is_open = true;
    reading_.motion.reset();
    reading_.trouble = PoseTrouble::kNotYet;
  }
  void check_age(int64_t) noexcept override {}
  ExchangeStatus exchange(const GripCommand& command) noexcept override {
    commands.push_back(command);
    reading_.delivered.force_N = command.wrench.force_N;
    if (answer != ExchangeStatus::kOk) {
      reading_.trouble = PoseTrouble::kNoReading;
      return answer;
    }
    reading_.pose.position_m = position_m;
    reading_.motion.see(reading_.pose, command.now_ns);
    reading_.trouble = known ? PoseTrouble::kNone : PoseTrouble::kNoFit;
    return answer;
  }
  const GripReading& reading() const noexcept override { return reading_; }
  void close() noexcept override { is_open = false; }
  const GripTraits& traits() const noexcept override { return traits_; }
  std::string description() const override { return "three axes"; }
  GripAbilities abilities() const noexcept override { return {{true, true, true}, false}; }
  LinkHealth health() const noexcept override { return {}; }
  const std::string& name() const noexcept override { return name_; }

 private:
  GripReading reading_;
  const GripTraits traits_;
  const std::string name_ = "fake";
};

}  // namespace spidar::test
