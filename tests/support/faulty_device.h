// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device between the loop and the simulated one, with strings that break, encoders that fail and
/// a link that is lost. Like a real board, it keeps its last output while nothing reaches it.
#pragma once

#include <array>
#include <string>

#include "spidar/device.h"
#include "spidar/devices/sim/simulated_device.h"
#include "tests/support/tampered_device.h"

namespace spidar::test {

class FaultyDevice final : public StringDevice {
 public:
  FaultyDevice(SimulatedDevice& inner, const Profile& profile)
      : StringDevice(inner.name()), inner_(inner), profile_(profile) {}

  /// Breaks a string: it no longer pulls, and its motor winds up the rest.
  void cut(int string) { cut_ |= 1u << string; }
  void stop_encoder(int string) { stopped_ |= 1u << string; }
  /// Adds counts to an encoder from now on.
  void shift(int string, int32_t counts) { move(static_cast<size_t>(string), counts); }
  /// Sets the fault of the link; kNone repairs it.
  void set_link(LinkFault link) { link_ = link; }

  /// Lets a millisecond pass without an exchange.
  void hold() {
    DeviceReading ignored;
    pass(ignored);
  }
  /// Sets the motors to zero volts from now on, if the link works.
  void zero() {
    if (link_ != LinkFault::kTimeout) volts_ = {};
  }
  /// The tensions at the strings when the motors have followed.
  StringVector told_N() const { return tensions_N(acting(), profile_); }

  void open() override {
    if (link_ != LinkFault::kNone) throw DeviceError("sim: the link is down");
    inner_.close();
    inner_.open();
    open_ = true;
    closing_ = false;
    volts_ = {};
  }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    if (link_ != LinkFault::kTimeout) volts_ = volts;
    DeviceReading read;
    const LinkFault status = pass(read);
    if (link_ != LinkFault::kNone) return link_;
    for (size_t i = 0; i < kMaxStrings; ++i)
      if (!(stopped_ >> i & 1)) last_.count[i] = read.count[i];
    reading = last_;
    return status;
  }
  /// Sends zeros; while the link does not work, the guardian waits and then sends them.
  void close() noexcept override { closing_ = true; }

 private:
  MotorVolts acting() const {
    MotorVolts volts = volts_;
    for (size_t i = 0; i < kMaxStrings; ++i)
      if (cut_ >> i & 1) volts.volt[i] = 0;
    return volts;
  }

  LinkFault pass(DeviceReading& reading) {
    if (!open_) return LinkFault::kGone;
    if (closing_) zero();
    // A free motor winds at 1 m/s while it has a voltage.
    for (size_t i = 0; i < kMaxStrings; ++i) {
      if (!(cut_ >> i & 1) || volts_.volt[i] == 0) continue;
      const StringDrive& drive = profile_.drives[i];
      move(i, static_cast<int32_t>(-drive.encoder_sign * 1e-3 / drive.metres_per_count));
    }
    return inner_.exchange(acting(), reading);
  }

  void move(size_t string, int32_t counts) {
    error_[string] += counts;
    inner_.set_count_error(static_cast<int>(string), error_[string]);
  }

  SimulatedDevice& inner_;
  const Profile& profile_;
  unsigned cut_ = 0;
  unsigned stopped_ = 0;
  bool open_ = false;
  bool closing_ = false;
  LinkFault link_ = LinkFault::kNone;
  MotorVolts volts_;
  DeviceReading last_;
  std::array<int32_t, kMaxStrings> error_{};
};

}  // namespace spidar::test
