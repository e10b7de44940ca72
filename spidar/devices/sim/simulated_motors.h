// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <optional>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/profiles/profile.h"

namespace spidar::emulated {

/// The mechanics that a simulated board drives.
struct SimulatedMechanics {
  std::optional<GripModel> model;  ///< none: that of the profile
  std::function<int64_t()> clock;  ///< none: CLOCK_MONOTONIC
};

/// The motors and encoders of a SimulatedDevice behind an emulated board. The mechanics advance
/// when the board outputs digits.
class SimulatedMotors final : public Motors {
 public:
  /// `dac` belongs to the board. Throws std::invalid_argument as SimulatedDevice does.
  SimulatedMotors(const Profile& profile, const boards::DacScale& dac,
                  const SimulatedMechanics& mechanics)
      : device_(profile, SimulatedDevice::Time::kClock,
                mechanics.model.value_or(grip_model_of(profile)), mechanics.clock),
        dac_(dac) {
    device_.open();
  }
  ~SimulatedMotors() override { device_.close(); }

  void set_outputs(const std::array<int, kMaxStrings>& digits) noexcept override {
    MotorVolts volts;
    for (size_t i = 0; i < digits.size(); ++i) volts.volt[i] = dac_.volt(digits[i]);
    device_.exchange(volts, reading_);
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override { return reading_.count; }

 private:
  SimulatedDevice device_;
  const boards::DacScale dac_;
  DeviceReading reading_;
};

}  // namespace spidar::emulated
