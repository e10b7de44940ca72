// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The simulated device behind a board's protocol.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "spidar/boards/board.h"
#include "spidar/device.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/profiles/profile.h"
#include "spidar/simulation/simulated_device.h"

namespace spidar {

/// The mechanics that a simulated board drives.
struct SimulatedMechanics {
  std::optional<GripModel> model;  ///< none: that of the profile
  SimulatedClock clock;            ///< none: CLOCK_MONOTONIC
};

/// `board`: "sh4", "simple" or "uart". Grip, hand and motors are those of
/// SimulatedDevice. Volts and counts pass through the packets and the code that drives the real
/// board. No thread and no guardian is started. `wire` causes faults. Null for another board.
/// Throws DeviceError when the board cannot drive the profile, and std::invalid_argument as
/// SimulatedDevice does.
std::unique_ptr<Device> make_wire_simulation(
    const std::string& board, const Profile& profile,
    std::shared_ptr<EmulatedWire> wire = std::make_shared<EmulatedWire>(),
    const SimulatedMechanics& mechanics = {});

/// Those of a board behind which everything is simulated: no thread and no guardian. The simulated
/// user begins at the centre, from which the profile's home offsets are counted.
BoardSettings settings_of_simulation();

}  // namespace spidar
