// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/profile_choice.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <unistd.h>

#include "spidar/devices/device_registry.h"
#include "spidar/devices/usb_search.h"
#include "spidar/folders.h"
#include "spidar/link/board_parts.h"
#include "spidar/part_file.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/profiles/toml.h"
#include "spidar/session/device_factory.h"
#include "spidar/whole_file.h"

namespace spidar {

namespace fs = std::filesystem;

fs::path remembered_profiles_file() {
  const fs::path folder = user_folder("XDG_CONFIG_HOME", ".config");
  return folder.empty() ? fs::path() : folder / "gst-spidar" / "boards.toml";
}

namespace {

constexpr size_t kMaxBoards_bytes = 1 << 20;  // some ten thousand boards

std::string key_of(const std::string& usb_id, const std::string& serial) {
  return usb_id + " " + serial;
}

/// Returns an empty table when there is no file. Throws ProfileError when the file cannot be read.
toml::table remembered_boards(const fs::path& file) {
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return {};
  try {
    return parse_toml(read_regular_file(file.string(), kMaxBoards_bytes), file.string());
  } catch (const ProfileError& fault) {
    throw ProfileError(std::string(fault.what()) + "; correct or remove the file");
  } catch (const std::runtime_error& fault) {
    throw ProfileError(file.string() + ": " + fault.what() + "; correct or remove the file");
  }
}

}  // namespace

std::string remembered_profile(const std::string& usb_id, const std::string& serial) {
  if (serial.empty()) return {};
  const fs::path file = remembered_profiles_file();
  const toml::table boards = remembered_boards(file);
  const toml::node* const profile = boards.get(key_of(usb_id, serial));
  if (!profile) return {};
  if (!profile->is_string()) {
    throw ProfileError(file.string() + ": \"" + key_of(usb_id, serial) +
                       "\" must be the name of a profile, in quotes");
  }
  return profile->as_string()->get();
}

void store_profile(const std::string& usb_id, const std::string& serial,
                   const std::string& profile) {
  const fs::path file = remembered_profiles_file();
  if (file.empty()) throw ProfileError("no profile can be remembered: this user has no home");
  toml::table boards = remembered_boards(file);
  const bool is_path =
      profile.find('/') != std::string::npos || fs::path(profile).extension() == ".toml";
  boards.insert_or_assign(key_of(usb_id, serial),
                          is_path ? fs::absolute(profile).string() : profile);
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ostringstream text;
  text << "# Profiles that were confirmed with spidarctl choose: \"USB-ID SERIAL\" = \"PROFILE\".\n"
       << boards << '\n';
  replace_file(file, text.str());
}

std::string without_profile(const DeviceInfo& board) {
  std::string why = board.path.empty()
                        ? "no board is plugged in whose profile is remembered, and none is named"
                        : "no profile is named for this board, and the board does not say which "
                          "frame, motors and encoders it has";
  if (!board.memory_error.empty()) why += " (" + board.memory_error + ")";
  return board.device + ": the motors get no force: " + why + ". " + fitting_text(board) +
         ". Name yours (profile=NAME, spidarctl --profile NAME), or confirm it once: spidarctl "
         "choose " +
         board.device + " --profile NAME";
}

namespace {

/// Throws DeviceError for a board that is not there; its profile does not matter then.
void require_plugged_in(const std::string& device) {
  const DeviceName name(device);
  const auto kinds = kinds_called(name.device);
  if (kinds.empty()) return;
  if (kinds[0]->usb.vendor != 0) {
    return UsbSearch(kinds, device, name.rest).require_one();
  }
  std::istringstream paths(name.rest);
  for (std::string path; std::getline(paths, path, ',');) {
    if (access(path.c_str(), F_OK) == 0) continue;
    const int error = errno;
    throw DeviceError(device + ": " + path + ": " + std::strerror(error) +
                          "; serial lines have names such as /dev/ttyUSB0 and /dev/serial/by-id/…",
                      error_code_of(error));
  }
}

/// Returns the kinds that a board may be of: two for a CyVerse board that is not plugged in.
std::vector<const DeviceKind*> kinds_of(const DeviceInfo& board) {
  if (board.name.empty()) return {};  // no device has this name
  std::vector<const DeviceKind*> kinds = kinds_called(DeviceName(board.device).device);
  const auto is_other = [&](const DeviceKind* kind) {
    return !board.profile_board.empty() && kind->profile_board != board.profile_board;
  };
  kinds.erase(std::remove_if(kinds.begin(), kinds.end(), is_other), kinds.end());
  return kinds;
}

/// Returns why the board cannot be driven with the profile; empty if it can.
std::string why_not(const DeviceInfo& board, const Profile& profile) {
  std::string names, why;
  for (const DeviceKind* kind : kinds_of(board)) {
    names += (names.empty() ? "" : " or ") + std::string(kind->profile_board);
    if (profile.board != kUnknownBoard && profile.board != kind->profile_board) continue;
    why = boards::misfit(profile, kind->traits);
    if (why.empty()) return {};
  }
  return board.device + ": profile \"" + profile.name + "\" " +
         (why.empty() ? "is for boards of the kind " + profile.board + ", and this is " + names
                      : why);
}

}  // namespace

std::vector<std::string> fitting_profiles(const DeviceInfo& board) {
  std::vector<std::string> fitting;
  for (const std::string& name : list_profiles()) {
    try {
      if (why_not(board, load_profile(name)).empty()) fitting.push_back(name);
    } catch (const ProfileError&) {
      continue;
    }
  }
  return fitting;
}

std::string fitting_text(const DeviceInfo& board) {
  std::string names;
  for (const std::string& name : fitting_profiles(board)) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "No profile that is known here fits it" : "Profiles that fit it: " + names;
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
  const std::string usual = default_profile(device);
  if (!usual.empty()) return load_profile(named.empty() ? usual : named);
  const DeviceInfo board = board_info(device);
  // The error says how such a board is named.
  if (board.name.empty()) make_device(device, load_profile(kDefaultProfile));
  if (named.empty() && board.profile.empty()) {
    require_plugged_in(device);
    throw DeviceError(without_profile(board), DeviceErrorCode::kSettings);
  }
  Profile profile = load_profile(named.empty() ? board.profile : named);
  const std::string why = why_not(board, profile);
  // A board whose name is wrong fits no profile.
  if (!why.empty()) {
    throw DeviceError(fitting_profiles(board).empty() ? why : why + ". " + fitting_text(board),
                      DeviceErrorCode::kSettings);
  }
  return profile;
}

std::string other_than_confirmed(const std::string& device, const std::string& named) {
  if (named.empty() || is_simulated(device)) return {};
  const DeviceInfo board = board_info(device);
  if (!board.has_strings || board.profile.empty() || is_same_profile(board.profile, named)) {
    return {};
  }
  return "profile=" + named + " drives " + device + ", for which profile " + board.profile +
         " was confirmed: with the profile of another device, forces are wrong, and motors may " +
         "pull where they should let go";
}

void require_serial(const DeviceInfo& board, const std::string& profile) {
  require_plugged_in(board.device);
  if (board.path.empty()) {
    throw DeviceError(board.device +
                          ": is one of several boards; name it by its bus path or serial "
                          "number, which spidarctl list prints",
                      DeviceErrorCode::kSettings);
  }
  if (board.serial.empty()) {
    throw DeviceError(
        board.device +
            ": has no serial number by which its profile could be remembered; name it each "
            "time: profile=" +
            profile,
        DeviceErrorCode::kSettings);
  }
}

void remember_profile(const DeviceInfo& board, const std::string& profile) {
  require_serial(board, profile);
  store_profile(board.usb_id, board.serial, profile);
}

}  // namespace spidar
