// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/profile_choice.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <toml++/toml.h>

#include "spidar/profiles/replace_file.h"
#include "spidar/session/device_factory.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// The key of a board in the file.
std::string key_of(const std::string& usb_id, const std::string& serial) {
  return usb_id + " " + serial;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string without_profile(const BoardInfo& board) {
  const std::string why =
      board.path.empty() ? "no board is plugged in whose profile is remembered, and none is named"
                         : "no profile is named for this board, and the board does not say which "
                           "frame, motors and encoders it has";
  return board.device + ": the motors get no force: " + why +
         ". Profiles that fit it: " + listed(fitting_profiles(board)) +
         ". Name yours (profile=NAME, spidarctl --profile NAME), or confirm it once: spidarctl "
         "choose " +
         board.device + " --profile NAME";
}

/// Whether profiles of this board's kind are for that board. A CyVerse board that is not plugged in
/// may be of either kind.
bool is_for(const std::string& profile_board, const BoardInfo& board) {
  if (profile_board == "unknown") return true;
  if (!board.profile_board.empty()) return profile_board == board.profile_board;
  return profile_board == "usb-sh4" || profile_board == "usb-simple";
}

}  // namespace

NoProfile::NoProfile(const BoardInfo& board) : DeviceError(without_profile(board)) {}

std::vector<std::string> fitting_profiles(const BoardInfo& board) {
  std::vector<std::string> fitting;
  for (const std::string& name : list_profiles()) {
    try {
      const Profile profile = load_profile(name);
      if (is_for(profile.board, board) && can_drive(board.device, profile)) fitting.push_back(name);
    } catch (const ProfileError&) {
      continue;
    }
  }
  return fitting;
}

bool can_drive(const std::string& device, const Profile& profile) {
  try {
    make_device(device, profile);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

Profile profile_for(const std::string& device, const std::string& named) {
  std::string name = named.empty() ? default_profile(device) : named;
  if (name.empty()) {
    const BoardInfo board = board_info(device);
    if (board.profile.empty()) throw NoProfile(board);
    name = board.profile;
  }
  return load_profile(name);
}

fs::path remembered_profiles_file() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value ? value : "");
  };
  // The specification ignores a relative path.
  fs::path folder = variable("XDG_CONFIG_HOME");
  if (!folder.is_absolute()) {
    folder = variable("HOME");
    if (!folder.is_absolute()) return {};
    folder /= ".config";
  }
  return folder / "gst-spidar" / "boards.toml";
}

std::string remembered_profile(const std::string& usb_id, const std::string& serial) {
  const fs::path file = remembered_profiles_file();
  std::error_code error;
  if (serial.empty() || file.empty() || !fs::is_regular_file(file, error)) return {};
  try {
    const toml::table boards = toml::parse_file(file.string());
    const toml::node* profile = boards.get(key_of(usb_id, serial));
    return profile ? profile->value_or(std::string()) : std::string();
  } catch (const toml::parse_error&) {
    return {};
  }
}

void remember_profile(const BoardInfo& board, const std::string& profile) {
  if (board.serial.empty())
    throw DeviceError(
        board.device +
        ": has no serial number by which its profile could be remembered; name it each "
        "time: profile=" +
        profile);
  const fs::path file = remembered_profiles_file();
  if (file.empty()) throw ProfileError("no profile can be remembered: HOME is not set");
  toml::table boards;
  std::error_code error;
  if (fs::exists(file, error)) {
    try {
      boards = toml::parse_file(file.string());
    } catch (const toml::parse_error& fault) {
      throw ProfileError(file.string() + ": " + std::string(fault.description()) +
                         "; correct or remove the file");
    }
  }
  const bool is_path =
      profile.find('/') != std::string::npos || fs::path(profile).extension() == ".toml";
  boards.insert_or_assign(key_of(board.usb_id, board.serial),
                          is_path ? fs::absolute(profile).string() : profile);
  fs::create_directories(file.parent_path(), error);
  std::ostringstream text;
  text << "# Profiles that were confirmed with spidarctl choose: \"USB-ID SERIAL\" = \"PROFILE\".\n"
       << boards << '\n';
  replace_file(file, text.str());
}

}  // namespace spidar
