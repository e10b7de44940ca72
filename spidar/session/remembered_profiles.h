// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The file in which it stands with which profile a board is driven.
#pragma once

#include <filesystem>
#include <string>

namespace spidar {

/// The file with the profiles that were confirmed for boards:
/// $XDG_CONFIG_HOME/gst-spidar/boards.toml, or ~/.config/gst-spidar/boards.toml. Empty when neither
/// variable is set.
std::filesystem::path remembered_profiles_file();

/// The profile that store_profile() last stored for the board with this USB ID and serial
/// number; empty if nothing. Throws ProfileError when the file cannot be read.
std::string remembered_profile(const std::string& usb_id, const std::string& serial);

/// A path is kept as an absolute one. Throws ProfileError if the file cannot be read, and as
/// replace_file().
void store_profile(const std::string& usb_id, const std::string& serial,
                   const std::string& profile);

}  // namespace spidar
