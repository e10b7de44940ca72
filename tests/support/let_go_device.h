// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "spidar/device.h"
#include "spidar/devices/sim/grip_model.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

/// A string device with a grip that a hand holds until it releases it. Its only steps are those of
/// the encoders.
class LetGoDevice final : public StringDevice {
 public:
  /// The pose of the hand at a time in seconds.
  using Hand = std::function<Pose(double)>;

  LetGoDevice(const Profile& profile, const GripModel& held, const GripModel& released)
      : StringDevice("let go"),
        profile_(profile),
        held_(profile.geometry, profile.max_tension_N(), held),
        released_(profile.geometry, profile.max_tension_N(), released) {}

  void let_go() { is_held_ = false; }
  void move_hand(Hand hand) { hand_ = std::move(hand); }
  /// Sets when the next exchange is, on the clock of the loop. By default, it is 1 ms after the
  /// last.
  void exchange_at(int64_t at_ns) { at_ns_ = at_ns; }
  /// From now on, this string does not pull; its counter stands still, like that of a drum whose
  /// motor soon winds up the rest.
  void cut(int string) { cut_[static_cast<size_t>(string)] = true; }
  const GripDynamics::State& state() const { return state_; }
  /// The wrench of the strings on the grip.
  Wrench string_wrench() const { return held_.string_wrench(state_); }
  double string_force_N() const { return string_wrench().force_N.norm(); }
  double speed_m_s() const { return state_.velocity_m_s.norm(); }

  void open() override {
    state_ = {};
    passed_ns_ = at_ns_;
  }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    const int64_t end_ns = at_ns_ > 0 ? at_ns_ : passed_ns_ + kStep_ns;
    while (passed_ns_ < end_ns) {
      const int64_t step_ns = std::min(kStep_ns, end_ns - passed_ns_);
      passed_ns_ += step_ns;
      const Pose hand = hand_ ? hand_(1e-9 * static_cast<double>(passed_ns_)) : Pose{};
      (is_held_ ? held_ : released_)
          .advance(tension_N_, hand, 1e-9 * static_cast<double>(step_ns), state_);
    }
    reading.read_ns = at_ns_;
    const StringVector change_m =
        string_lengths_m(profile_.geometry, state_.pose) - profile_.zero_count_length_m();
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile_.drives[k];
      if (cut_[k]) {
        tension_N_[i] = state_.tension_N[i] = 0;
        reading.count[k] = last_[k];
        continue;
      }
      tension_N_[i] = std::clamp(volts.volt[k] * drive.motor_sign * drive.newtons_per_volt, 0.0,
                                 drive.max_tension_N);
      reading.count[k] = drive.encoder_sign *
                         static_cast<int32_t>(std::lround(change_m[i] / drive.metres_per_count));
      last_[k] = reading.count[k];
    }
    return LinkFault::kNone;
  }
  void close() noexcept override { tension_N_.setZero(); }

 private:
  const Profile profile_;
  const GripDynamics held_, released_;
  static constexpr int64_t kStep_ns = 1'000'000;

  bool is_held_ = true;
  std::array<bool, kMaxStrings> cut_{};
  std::array<int32_t, kMaxStrings> last_{};
  Hand hand_;
  int64_t at_ns_ = 0;
  int64_t passed_ns_ = 0;
  GripDynamics::State state_;
  StringVector tension_N_ = StringVector::Zero();
};

}  // namespace spidar::test
