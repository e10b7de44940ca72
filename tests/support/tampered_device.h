// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

class TamperedDevice final : public StringDevice {
 public:
  /// A device placed between the loop and another device `inner`, which must outlive it: makes some
  /// encoders dead, and records the volts for the motors.
  explicit TamperedDevice(StringDevice& inner) : StringDevice(inner.name()), inner_(inner) {}

  /// From the next exchange on, the counters of these strings (bit i: string i) stand still.
  void stop_encoders(unsigned strings) { stopped_ = strings; }

  /// Flips this bit of the count of a string in the next answer.
  void flip(size_t string, int bit) {
    flipped_ = string;
    flip_ = 1 << bit;
  }

  bool is_tampered() const { return stopped_ != 0; }

  const MotorVolts& volts() const { return volts_; }
  LinkFault status() const { return status_; }

  void open() override {
    volts_ = {};
    inner_.open();
  }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    DeviceReading read;
    status_ = inner_.exchange(volts, read);
    // After a garbled answer the board has received the volts; a board that is gone releases the
    // motors.
    if (status_ != LinkFault::kTimeout) volts_ = volts;
    if (status_ == LinkFault::kGone) volts_ = {};
    if (status_ != LinkFault::kNone) return status_;
    for (size_t i = 0; i < kMaxStrings; ++i)
      if (!(stopped_ >> i & 1)) last_.count[i] = read.count[i];
    last_.read_ns = read.read_ns;
    reading = last_;
    reading.count[flipped_] ^= std::exchange(flip_, 0);
    return status_;
  }
  void close() noexcept override {
    volts_ = {};
    inner_.close();
  }

 private:
  StringDevice& inner_;
  unsigned stopped_ = 0;
  size_t flipped_ = 0;
  int32_t flip_ = 0;
  MotorVolts volts_;
  LinkFault status_ = LinkFault::kGone;
  DeviceReading last_;
};

/// The tensions of the volts at the strings, N.
inline StringVector tensions_N(const MotorVolts& volts, const Profile& profile) {
  StringVector tension_N = StringVector::Zero();
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    tension_N[i] = drive.motor_sign * volts.volt[k] * drive.newtons_per_volt;
  }
  return tension_N;
}

/// The true profile when the counters were set to zero with the grip at `pose` instead of the
/// centre.
inline Profile zeroed_at(Profile profile, const Pose& pose) {
  const StringVector off_m =
      string_lengths_m(profile.geometry, pose) - string_lengths_m(profile.geometry, {});
  for (int i = 0; i < profile.geometry.count; ++i)
    profile.drives[static_cast<size_t>(i)].home_offset_m += off_m[i];
  return profile;
}

}  // namespace spidar::test
