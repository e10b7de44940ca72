// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Simulated devices that are wired differently from their profile.
#pragma once

#include <string>

#include "spidar/tools/chosen_device.h"

namespace spidar {

/// Adds --sim-wiring to `options`. `faults` must outlive the result.
CommandOption sim_wiring_option(std::string& faults);

/// Does nothing when `faults` is empty. Throws UsageError when `faults` is invalid or the device is
/// not simulated.
void miswire(const std::string& faults, const std::string& name, const Profile& profile,
             std::unique_ptr<Device>& device);

/// Makes the drives lag by this, whatever the profile says. Throws UsageError when the device is
/// not simulated.
void simulate_lag(double lag_s, const std::string& device, ChosenDevice& chosen);

}  // namespace spidar
