// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A grip that a hand holds until it lets go.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/simulation/grip_model.h"

namespace spidar::test {

/// A string device of 1 ms per exchange, with the steps of its encoders and no others.
class LetGoDevice final : public StringDevice {
 public:
  LetGoDevice(const Profile& profile, const GripModel& held, const GripModel& released)
      : profile_(profile),
        held_(profile.geometry, profile.max_tension_N(), held),
        released_(profile.geometry, profile.max_tension_N(), released) {}

  void let_go() { is_held_ = false; }
  double speed_m_s() const { return state_.velocity_m_s.norm(); }

  void open() override { state_ = {}; }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    (is_held_ ? held_ : released_).advance(tension_N_, {}, 1e-3, state_);
    const StringVector change_m =
        string_lengths_m(profile_.geometry, state_.pose) - profile_.zero_count_length_m();
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile_.drives[k];
      tension_N_[i] = std::clamp(volts.volt[k] * drive.motor_sign * drive.newtons_per_volt, 0.0,
                                 drive.max_tension_N);
      reading.count[k] = drive.encoder_sign *
                         static_cast<int32_t>(std::lround(change_m[i] / drive.metres_per_count));
    }
    return LinkFault::kNone;
  }
  void close() noexcept override { tension_N_.setZero(); }
  const std::string& name() const noexcept override { return name_; }

 private:
  const Profile profile_;
  const GripDynamics held_, released_;
  const std::string name_ = "let go";
  bool is_held_ = true;
  GripDynamics::State state_;
  StringVector tension_N_ = StringVector::Zero();
};

}  // namespace spidar::test
