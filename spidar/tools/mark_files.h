// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstring>
#include <deque>
#include <filesystem>
#include <string>
#include <system_error>

namespace spidar::tools {

/// Puts "./" before names of files that begin with a dash, so that they are not taken for options:
/// the name has a point, and the file exists. Arguments after "--" may be properties.
inline void mark_files(int argc, char** argv, bool has_properties_last = true) {
  static std::deque<std::string> marked;  // lives as long as argv
  for (int i = 1; i < argc; ++i) {
    if (has_properties_last && std::strcmp(argv[i], "--") == 0) return;
    std::error_code none;
    if (argv[i][0] != '-' || !std::strchr(argv[i], '.') ||
        !std::filesystem::exists(argv[i], none)) {
      continue;
    }
    argv[i] = marked.emplace_back(std::string("./") + argv[i]).data();
  }
}

}  // namespace spidar::tools
