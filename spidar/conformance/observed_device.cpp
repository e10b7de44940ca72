// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/observed_device.h"

#include <algorithm>
#include <cstdlib>

namespace spidar {

void ObservedDevice::open() {
  device_->open();
  seen_.begin(device_->description());
}

ExchangeStatus ObservedDevice::exchange(const MotorVolts& volts, DeviceReading& reading) noexcept {
  const ExchangeStatus status = seen_.timed([&] { return device_->exchange(volts, reading); });
  if (status == ExchangeStatus::kOk) look_at(reading);
  return status;
}

void ObservedDevice::look_at(const DeviceReading& reading) noexcept {
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

}  // namespace spidar
