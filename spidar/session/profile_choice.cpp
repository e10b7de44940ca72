// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/profile_choice.h"

#include "spidar/session/device_factory.h"

namespace spidar {
namespace {

std::string without_profile(const BoardInfo& board) {
  const std::string why = board.path.empty()
                              ? "no profile is named"
                              : "no profile is named for this board, and the board does not say "
                                "which frame, motors and encoders it has";
  return board.device + ": the motors get no force: " + why + ". " + fitting_text(board) +
         ". Name yours: profile=NAME, spidarctl --profile NAME";
}

/// Whether profiles of this board's kind are for that board. A CyVerse board that is not plugged in
/// may be of either kind.
bool is_for(const std::string& profile_board, const BoardInfo& board) {
  if (profile_board == "unknown") return true;
  if (!board.profile_board.empty()) return profile_board == board.profile_board;
  return profile_board == "usb-sh4" || profile_board == "usb-simple";
}

/// Why the board cannot be driven with the profile; empty if it can.
std::string misfit(const BoardInfo& board, const Profile& profile) {
  if (!is_for(profile.board, board))
    return board.device + ": profile \"" + profile.name + "\" is for boards of the kind " +
           profile.board + ", and this is " +
           (board.profile_board.empty() ? "usb-sh4 or usb-simple" : board.profile_board);
  try {
    make_device(board.device, profile);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace

NoProfile::NoProfile(const BoardInfo& board) : DeviceError(without_profile(board)) {}

std::vector<std::string> fitting_profiles(const BoardInfo& board) {
  std::vector<std::string> fitting;
  for (const std::string& name : list_profiles()) {
    try {
      if (misfit(board, load_profile(name)).empty()) fitting.push_back(name);
    } catch (const ProfileError&) {
      continue;
    }
  }
  return fitting;
}

std::string fitting_text(const BoardInfo& board) {
  std::string names;
  for (const std::string& name : fitting_profiles(board))
    names += (names.empty() ? "" : ", ") + name;
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
  const BoardInfo board = board_info(device);
  // Its error says how such a board is named.
  if (board.name.empty()) make_device(device, load_profile(kDefaultProfile));
  if (named.empty() && board.profile.empty()) throw NoProfile(board);
  Profile profile = load_profile(named.empty() ? board.profile : named);
  const std::string why = misfit(board, profile);
  // None fits a board whose name is not right.
  if (!why.empty())
    throw DeviceError(fitting_profiles(board).empty() ? why : why + ". " + fitting_text(board));
  return profile;
}

}  // namespace spidar
