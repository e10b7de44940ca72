// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which profile drives a device.
///
/// A wrong profile exerts other forces than wanted, and may pull where it should release, because
/// boards do not report which frame, motors and encoders are connected to them. A board gets no
/// force before somebody has named a profile, now or once with `spidarctl choose`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"

namespace spidar {

/// The file with the profiles that were confirmed for boards:
/// $XDG_CONFIG_HOME/gst-spidar/boards.toml, or ~/.config/gst-spidar/boards.toml. Empty without
/// both.
std::filesystem::path remembered_profiles_file();

/// The profile that store_profile() last stored for the board with this USB ID and serial number;
/// empty if none. Throws ProfileError when the file cannot be read.
std::string remembered_profile(const std::string& usb_id, const std::string& serial);

/// Stores the profile for the board with this USB ID and serial number; a relative path becomes
/// absolute. Throws ProfileError if the file cannot be read, and as replace_file() does.
void store_profile(const std::string& usb_id, const std::string& serial,
                   const std::string& profile);

/// A message that nobody has named a profile for this board; lists the profiles that fit it.
std::string without_profile(const DeviceInfo& board);

/// The names of the profiles that fit a board: the board can drive them, and their source names a
/// board of its kind or none. Profiles that cannot be read are left out. Opens nothing.
std::vector<std::string> fitting_profiles(const DeviceInfo& board);

/// A sentence, without its full stop, that lists the fitting profiles.
std::string fitting_text(const DeviceInfo& board);

/// Whether make_device() accepts the profile for this device. Opens nothing.
bool can_drive(const std::string& device, const Profile& profile);

/// Loads the profile `named`, which is a name or a path as for load_profile(). If `named` is empty,
/// loads DeviceInfo::profile. Throws DeviceError if both are empty, when the profile does not fit
/// the board, or when there is no such device, and ProfileError.
Profile profile_for(const std::string& device, const std::string& named);

/// Why the profile `named` may be wrong: another one was confirmed for this board. Empty if not.
std::string other_than_confirmed(const std::string& device, const std::string& named);

/// Throws DeviceError, which says what to do instead, if the board has no serial number by which
/// its `profile` could be remembered.
void require_serial(const DeviceInfo& board, const std::string& profile);

/// Stores `profile`, a name or a path as for load_profile(), for this board. Throws as
/// require_serial() and store_profile() do.
void remember_profile(const DeviceInfo& board, const std::string& profile);

}  // namespace spidar
