// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Makes devices by name.
#pragma once

#include <memory>
#include <string>

#include "spidar/device.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/grip/grip.h"
#include "spidar/link/board.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Whether this device moves nothing real: "sim", "sim:sh4", …
bool is_simulated(const std::string& spec);

/// `spec` is "sim", the simulated device; "sim:BOARD", the simulation behind an emulated board; or
/// the name of a real device, in one of these forms:
///   usb, usb:ID             ID: rotary switch, serial number or bus path
///   uart:PATH[,PATH]        serial lines
///   ff, ff:PATH[,OPTION]…   the first one, or this file; OPTION: axes=1 for a wheel or axes=2 for
///                           a joystick, if it is taken for the other; gain=PERCENT of its strength
///                           (20); flip=x, y or xy if its driver pushes to the other side
///   mouse, falcon, …; NAME:ID
///                           a device on USB without strings; ID: serial number or bus path
///   inverse3, inverse3:ID[,port=N]
///                           the first one of the maker's service, or this one
///   sound:CARD[,OPTION]…    this sound card; OPTION: 3=x for the direction that a channel plays,
///                           carrier=HZ, gain=PERCENT (see sound::Settings)
/// Opens nothing. Throws DeviceError, which lists the valid names or explains why the board cannot
/// drive the profile, and std::invalid_argument when a device with strings gets a profile with
/// fewer than six. "none" is not a device, because it needs no loop.
std::unique_ptr<Grip> make_grip(const std::string& spec, const Profile& profile,
                                const boards::Settings& settings = {});

/// Makes the device "sim". Throws DeviceError as above.
std::unique_ptr<SimulatedDevice> make_simulation(const Profile& profile);

/// Makes a device that takes volts and returns counts of strings. Throws DeviceError as above, and
/// for a device that takes a force, which has no strings.
std::unique_ptr<StringDevice> make_device(const std::string& spec, const Profile& profile,
                                          const boards::Settings& settings = {});

/// The settings of a board behind which everything is simulated: no thread and no guardian. The
/// simulated user begins at the centre, from which the profile's home offsets are counted.
boards::Settings settings_of_simulation();

}  // namespace spidar
