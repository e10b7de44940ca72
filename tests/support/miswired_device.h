// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "spidar/device.h"

namespace spidar::test {

/// A wrongly wired device. `faults` are separated by semicolons; channels count from zero:
/// `swap-motors:I,J`, `swap-encoders:I,J`, `swap-strings:I,J` (both), `reverse-motor:I`,
/// `reverse-encoder:I`, `cut-motor:I`, `cut-encoder:I`.
class MiswiredDevice final : public StringDevice {
 public:
  MiswiredDevice(std::unique_ptr<StringDevice> device, const std::string& faults)
      : StringDevice(device->name()), device_(std::move(device)) {
    for (size_t i = 0; i < channel_.size(); ++i) channel_[i] = {i, i, 1, 1};
    std::istringstream in(faults);
    for (std::string fault; std::getline(in, fault, ';');) apply(fault);
  }

  void open() override { device_->open(); }
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    MotorVolts wired;
    for (size_t i = 0; i < channel_.size(); ++i)
      wired.volt[channel_[i].motor] = channel_[i].motor_sign * volts.volt[i];
    DeviceReading right;
    const LinkFault status = device_->exchange(wired, right);
    if (status != LinkFault::kNone) return status;
    reading = right;
    for (size_t i = 0; i < channel_.size(); ++i)
      reading.count[i] = channel_[i].encoder_sign * right.count[channel_[i].encoder];
    return status;
  }
  void close() noexcept override { device_->close(); }

 private:
  /// The connections of a channel of the board.
  struct Channel {
    size_t motor = 0, encoder = 0;         // strings
    int motor_sign = 1, encoder_sign = 1;  // −1: wires reversed; 0: cut
  };

  void apply(const std::string& fault) {
    const size_t colon = fault.find(':');
    const std::string kind = fault.substr(0, colon);
    Channel& one = channel_.at(std::stoul(fault.substr(colon + 1)));
    const bool motor = kind.find("motor") != std::string::npos;
    if (kind.find("swap") == 0) {
      Channel& other = channel_.at(std::stoul(fault.substr(fault.find(',') + 1)));
      if (kind != "swap-encoders") std::swap(one.motor, other.motor);
      if (kind != "swap-motors") std::swap(one.encoder, other.encoder);
    } else {
      (motor ? one.motor_sign : one.encoder_sign) *= kind.find("cut") == 0 ? 0 : -1;
    }
  }

  const std::unique_ptr<StringDevice> device_;
  std::array<Channel, kMaxStrings> channel_;
};

}  // namespace spidar::test
