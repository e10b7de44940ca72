// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// What is known of a kind of device, and how it is made. `spec` is the whole name of a device, as
/// for make_grip().
struct ForceDevice {
  const char* kind;       ///< its name, up to the colon
  const char* title;      ///< for people
  const char* simulated;  ///< the same, of `sim:KIND`
  const char* names;      ///< how it may be named, separated by ", "
  Trial trial;
  /// `rest` is what follows the colon. Opens nothing. Throws DeviceError when `rest` is wrong.
  std::unique_ptr<ForceBoard> (*make)(const std::string& spec, const std::string& rest,
                                      const Profile& profile);
  /// The board behind its packets, which an emulation answers.
  std::unique_ptr<ForceBoard> (*simulate)(const std::string& spec, const Profile& profile);
};

const std::vector<ForceDevice>& force_devices();

/// Null when no such device takes a force.
const ForceDevice* force_device(const std::string& kind);

/// Whether this device moves nothing real: "sim", "sim:sh4", …
bool is_simulated(const std::string& spec);

/// `spec` is one of
///   sim                     the simulated device
///   sim:sh4, sim:simple, sim:uart, sim:mouse, sim:ff, sim:inverse3, sim:falcon
///                           the same behind the packets of that board
///   usb, usb:ID             CyVerse board; ID: rotary switch, serial number or bus path
///   uart:PATH[,PATH]        UART motor boards on serial lines
///   mouse, mouse:ID         SPIDAR-mouse; ID: serial number or bus path
///   falcon, falcon:ID       Novint Falcon; ID: serial number or bus path
///   ff, ff:PATH[,OPTION]…   joystick, wheel or gamepad with force feedback: the first one, or
///                           this file; OPTION: axes=1 for a wheel or axes=2 for a joystick, if it
///                           is taken for the other; gain=PERCENT of its strength (20);
///                           flip=x, y or xy if its driver pushes to the other side
///   inverse3, inverse3:ID[,port=N]
///                           Haply Inverse3: the first one of the maker's service, or this one
/// Opens nothing. Throws DeviceError, which lists the valid names or explains why the board cannot
/// drive the profile, and std::invalid_argument when a device with strings gets a profile with
/// fewer than six. "none" is not a device, because it needs no loop.
std::unique_ptr<Grip> make_grip(const std::string& spec, const Profile& profile,
                                const BoardSettings& settings = {});

/// Makes a device that takes volts and gives counts of the strings. Throws DeviceError as above,
/// and for a device that takes a force, which has no strings.
std::unique_ptr<Device> make_device(const std::string& spec, const Profile& profile,
                                    const BoardSettings& settings = {});

}  // namespace spidar
