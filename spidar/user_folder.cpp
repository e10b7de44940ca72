// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/user_folder.h"

#include <array>
#include <cstdlib>
#include <pwd.h>
#include <unistd.h>

namespace spidar {

namespace fs = std::filesystem;

namespace {

fs::path named(const char* variable) {
  const char* const value = secure_getenv(variable);
  return value ? value : "";
}

fs::path home() {
  fs::path folder = named("HOME");
  if (folder.is_absolute()) return folder;
  std::array<char, 16384> text{};  // more than _SC_GETPW_R_SIZE_MAX
  passwd entry{}, *found = nullptr;
  getpwuid_r(geteuid(), &entry, text.data(), text.size(), &found);
  return found && found->pw_dir ? found->pw_dir : "";
}

}  // namespace

fs::path user_folder(const char* variable, const char* below_home) {
  fs::path folder = named(variable);
  if (folder.is_absolute()) return folder;
  folder = home();
  return folder.is_absolute() ? folder / below_home : fs::path();
}

}  // namespace spidar
