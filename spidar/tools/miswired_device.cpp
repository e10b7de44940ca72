// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/miswired_device.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace spidar {
namespace {

constexpr const char* kKnown =
    "swap-motors:I,J, swap-encoders:I,J, swap-strings:I,J, reverse-motor:I, reverse-encoder:I, "
    "cut-motor:I, cut-encoder:I";

[[noreturn]] void refuse(const std::string& fault, int strings) {
  throw std::invalid_argument("\"" + fault + "\" is not a wiring fault; known faults are " +
                              kKnown + ", channels are 0 to " + std::to_string(strings - 1));
}

/// One or two channels after the colon.
std::array<size_t, 2> channels_of(const std::string& fault, int strings, bool two) {
  std::istringstream in(fault.substr(fault.find(':') + 1));
  int first = -1, second = 0;
  char comma = ',';
  in >> first;
  if (two) in >> comma >> second;
  std::string more;
  const bool in_range = first >= 0 && first < strings && second >= 0 && second < strings;
  if (!in || comma != ',' || in >> more || !in_range || (two && first == second))
    refuse(fault, strings);
  return {static_cast<size_t>(first), static_cast<size_t>(second)};
}

void apply(const std::string& fault, int strings, Miswiring& wiring) {
  const std::string kind = fault.substr(0, fault.find(':'));
  const bool motors = kind == "swap-motors" || kind == "swap-strings";
  const bool encoders = kind == "swap-encoders" || kind == "swap-strings";
  const auto [a, b] = channels_of(fault, strings, motors || encoders);
  Miswiring::Channel& one = wiring.channel[a];
  Miswiring::Channel& other = wiring.channel[b];
  if (motors) std::swap(one.motor, other.motor);
  if (encoders) std::swap(one.encoder, other.encoder);
  if (motors || encoders) return;
  if (kind == "reverse-motor") {
    one.motor_sign *= -1;
  } else if (kind == "reverse-encoder") {
    one.encoder_sign *= -1;
  } else if (kind == "cut-motor") {
    one.motor_sign = 0;
  } else if (kind == "cut-encoder") {
    one.encoder_sign = 0;
  } else {
    refuse(fault, strings);
  }
}

class MiswiredDevice final : public Device {
 public:
  MiswiredDevice(std::unique_ptr<Device> device, const Miswiring& wiring)
      : device_(std::move(device)), wiring_(wiring) {}

  void open() override { device_->open(); }

  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    MotorVolts wired;
    for (size_t i = 0; i < wiring_.channel.size(); ++i) {
      const Miswiring::Channel& channel = wiring_.channel[i];
      wired.volt[static_cast<size_t>(channel.motor)] = channel.motor_sign * volts.volt[i];
    }
    DeviceReading right;
    const ExchangeStatus status = device_->exchange(wired, right);
    if (status != ExchangeStatus::kOk) return status;
    reading = right;
    for (size_t i = 0; i < wiring_.channel.size(); ++i) {
      const Miswiring::Channel& channel = wiring_.channel[i];
      reading.count[i] = channel.encoder_sign * right.count[static_cast<size_t>(channel.encoder)];
    }
    return status;
  }

  void close() noexcept override { device_->close(); }
  LinkHealth health() const noexcept override { return device_->health(); }
  const std::string& name() const noexcept override { return device_->name(); }

 private:
  const std::unique_ptr<Device> device_;
  const Miswiring wiring_;
};

}  // namespace

Miswiring::Miswiring() {
  for (size_t i = 0; i < channel.size(); ++i)
    channel[i].motor = channel[i].encoder = static_cast<int>(i);
}

Miswiring parse_miswiring(const std::string& text, int strings) {
  Miswiring wiring;
  std::istringstream in(text);
  for (std::string fault; std::getline(in, fault, ';');) apply(fault, strings, wiring);
  return wiring;
}

std::unique_ptr<Device> make_miswired(std::unique_ptr<Device> device, const Miswiring& wiring) {
  return std::make_unique<MiswiredDevice>(std::move(device), wiring);
}

}  // namespace spidar
