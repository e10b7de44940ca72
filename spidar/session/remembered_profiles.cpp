// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/remembered_profiles.h"

#include <cstdlib>
#include <sstream>

#include <toml++/toml.h>

#include "spidar/profiles/profile.h"
#include "spidar/whole_file.h"

namespace spidar {

namespace fs = std::filesystem;

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

namespace {

/// The key of a board in the file.
std::string key_of(const std::string& usb_id, const std::string& serial) {
  return usb_id + " " + serial;
}

/// Empty when there is no file. Throws ProfileError when it cannot be read.
toml::table remembered_boards(const fs::path& file) {
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return {};
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& fault) {
    throw ProfileError(file.string() + ": " + std::string(fault.description()) +
                       "; correct or remove the file");
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
  if (file.empty()) throw ProfileError("no profile can be remembered: HOME is not set");
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

}  // namespace spidar
