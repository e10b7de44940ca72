// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device whose exchanges are measured.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "spidar/device.h"
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

  void open() override;
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override;
  void close() noexcept override { device_->close(); }
  std::string description() const override { return device_->description(); }
  LinkHealth health() const noexcept override { return device_->health(); }
  const std::string& name() const noexcept override { return device_->name(); }

  const Observation& seen() const noexcept { return seen_; }

 private:
  void look_at(const DeviceReading& reading) noexcept;

  const std::unique_ptr<Device> device_;
  Observation seen_;
  DeviceReading last_;
};

}  // namespace spidar
