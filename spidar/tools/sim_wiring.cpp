// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/sim_wiring.h"

#include <stdexcept>
#include <utility>

#include "spidar/session/device_factory.h"
#include "spidar/tools/miswired_device.h"

namespace spidar {

CommandOption sim_wiring_option(std::string& faults) {
  return {"sim-wiring", true, [&faults](const std::string& text) { faults = text; }};
}

void miswire(const std::string& faults, const std::string& name, const Profile& profile,
             std::unique_ptr<Device>& device) {
  if (faults.empty()) return;
  if (!is_simulated(name))
    throw UsageError("--sim-wiring is for simulated devices only, not for " + name);
  try {
    device = make_miswired(std::move(device), parse_miswiring(faults, profile.geometry.count));
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--sim-wiring: ") + error.what());
  }
}

void simulate_lag(double lag_s, const std::string& device, ChosenDevice& chosen) {
  if (!is_simulated(device))
    throw UsageError("--sim-lag is for simulated devices only, not for " + device);
  Profile lagging = chosen.profile;
  lagging.drive_lag_s = lag_s;
  chosen.device = make_device(device, lagging);
}

}  // namespace spidar
