// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/rehearsed_grip.h"

#include <cmath>

#include <Eigen/Core>

#include "spidar/calibration/samples.h"

namespace spidar::test {

RehearsedGrip::RehearsedGrip(const Profile& profile, const boards::DacScale& dac)
    : profile_(profile),
      dac_(dac),
      device_(profile, SimulatedDevice::Time::kClock, grip_model_of(profile)) {
  device_.open();
}

RehearsedGrip::~RehearsedGrip() {
  device_.close();
}

void RehearsedGrip::lead_hand(const Rehearsal& rehearsal, int64_t now_ns) {
  if (rehearsal.moves_about) {
    const double moved_s = 1e-9 * static_cast<double>(now_ns - began_ns_);
    device_.set_hand(calibration::hand_in_motion(profile_.geometry, moved_s));
    device_.lead_hand(std::nullopt);
    return;
  }
  began_ns_ = now_ns;
  device_.lead_hand(
      1e-6 * Eigen::Vector3d(rehearsal.hand_um[0], rehearsal.hand_um[1], rehearsal.hand_um[2]));
}

void RehearsedGrip::tell_arrival(Rehearsal& rehearsal) {
  // Slower than a hand trembles, for longer than a motion takes to begin.
  constexpr double kStill_m_s = 0.005;
  constexpr int64_t kStill_ns = 50'000'000;
  const int moves = rehearsal.moves;
  if (moves != moves_ || device_.felt().velocity_m_s.norm() > kStill_m_s) still_ns_ = now_ns_;
  moves_ = moves;
  if (now_ns_ - still_ns_ > kStill_ns) rehearsal.arrived = moves;
}

void RehearsedGrip::follow(UsbPort& port, Rehearsal& rehearsal) {
  const bool powered = port.kind != 0 && !rehearsal.stopped;
  const unsigned broken = rehearsal.broken;
  lead_hand(rehearsal, now_ns_);
  MotorVolts volts;
  for (size_t i = 0; powered && i < kMaxStrings; ++i) {
    volts.volt[i] = (broken >> i & 1) != 0 ? 0 : dac_.volt(port.digit[i]);
  }
  DeviceReading reading;
  device_.exchange(volts, reading);
  const int64_t now_ns = device_.felt().time_ns;
  const double passed_s = 1e-9 * static_cast<double>(now_ns - now_ns_);
  now_ns_ = now_ns;
  tell_arrival(rehearsal);
  const bool begins = rehearsal.restarts != restarts_;
  restarts_ = rehearsal.restarts;
  for (size_t i = 0; i < kMaxStrings; ++i) {
    const StringDrive& drive = profile_.drives[i];
    if ((broken >> i & 1) == 0) {
      wound_m_[i] = 0;
    } else if (powered && drive.motor_sign * port.digit[i] > 0) {
      wound_m_[i] += kWinds_m_s * passed_s;
    }
    const double wound = drive.metres_per_count > 0 ? wound_m_[i] / drive.metres_per_count : 0;
    const auto count =
        static_cast<int32_t>(reading.count[i] - drive.encoder_sign * std::lround(wound));
    if (begins) zero_[i] = count;
    port.count[i] = count - zero_[i];
  }
}

}  // namespace spidar::test
