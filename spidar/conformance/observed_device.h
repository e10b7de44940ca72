// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device, or a grip, whose exchanges are measured.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {

/// Statistics over the whole time in which a device was open.
struct Observation {
  std::string description;  ///< as of the last opening
  uint64_t exchanges = 0;
  uint64_t answered = 0;
  LatencyHistogram duration;  ///< of an exchange
  LatencyHistogram period;    ///< from one exchange to the next, while it stayed open
  std::array<int32_t, kMaxStrings> smallest{};
  std::array<int32_t, kMaxStrings> largest{};
  /// Between two successive answers, in either direction.
  std::array<int64_t, kMaxStrings> largest_step{};
  uint32_t inputs = 0;          ///< of the first answer
  uint32_t changed_inputs = 0;  ///< inputs that have ever differed from that

  void begin(const std::string& opened_as) {
    description = opened_as;
    last_begin_ns = 0;
  }
  /// Makes one exchange and measures it.
  template <typename Exchange>
  ExchangeStatus timed(const Exchange& exchange) noexcept {
    const int64_t begin_ns = monotonic_now_ns();
    const ExchangeStatus status = exchange();
    if (last_begin_ns != 0) period.add(begin_ns - last_begin_ns);
    last_begin_ns = begin_ns;
    ++exchanges;
    if (status != ExchangeStatus::kOk) return status;
    duration.add(monotonic_now_ns() - begin_ns);
    ++answered;
    return status;
  }

  int64_t last_begin_ns = 0;  ///< 0: no exchange since it was opened
};

/// Forwards all calls to the device. Not thread-safe.
class ObservedDevice final : public Device {
 public:
  explicit ObservedDevice(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  void open() override {
    device_->open();
    seen_.begin(device_->description());
  }
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    const ExchangeStatus status = seen_.timed([&] { return device_->exchange(volts, reading); });
    if (status == ExchangeStatus::kOk) look_at(reading);
    return status;
  }
  void close() noexcept override { device_->close(); }
  std::string description() const override { return device_->description(); }
  LinkHealth health() const noexcept override { return device_->health(); }
  const std::string& name() const noexcept override { return device_->name(); }

  const Observation& seen() const noexcept { return seen_; }

 private:
  void look_at(const DeviceReading& reading) noexcept {
    if (seen_.answered == 1) {
      seen_.smallest = seen_.largest = reading.count;
      seen_.inputs = reading.inputs;
      last_ = reading;
    }
    for (size_t i = 0; i < kMaxStrings; ++i) {
      const int32_t count = reading.count[i];
      seen_.smallest[i] = std::min(seen_.smallest[i], count);
      seen_.largest[i] = std::max(seen_.largest[i], count);
      const int64_t step = std::abs(int64_t{count} - last_.count[i]);
      seen_.largest_step[i] = std::max(seen_.largest_step[i], step);
    }
    seen_.changed_inputs |= reading.inputs ^ seen_.inputs;
    last_ = reading;
  }

  const std::unique_ptr<Device> device_;
  Observation seen_;
  DeviceReading last_;
};

/// Forwards all calls to the grip. Not thread-safe.
class ObservedGrip final : public Grip {
 public:
  explicit ObservedGrip(std::unique_ptr<Grip> grip) : grip_(std::move(grip)) {}

  void open() override {
    grip_->open();
    seen_.begin(grip_->description());
  }
  void pass(double passed_s) noexcept override { grip_->pass(passed_s); }
  void check_age(int64_t now_ns) noexcept override { grip_->check_age(now_ns); }
  ExchangeStatus exchange(const GripCommand& command) noexcept override {
    return seen_.timed([&] { return grip_->exchange(command); });
  }
  const GripReading& reading() const noexcept override { return grip_->reading(); }
  void close() noexcept override { grip_->close(); }
  const GripTraits& traits() const noexcept override { return grip_->traits(); }
  std::string description() const override { return grip_->description(); }
  GripAbilities abilities() const noexcept override { return grip_->abilities(); }
  LinkHealth health() const noexcept override { return grip_->health(); }
  const std::string& name() const noexcept override { return grip_->name(); }

  const Observation& seen() const noexcept { return seen_; }

 private:
  const std::unique_ptr<Grip> grip_;
  Observation seen_;
};

}  // namespace spidar
