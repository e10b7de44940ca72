// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/tty_list.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace spidar {
namespace {

bool begins(const std::string& name, const char* with) {
  return name.rfind(with, 0) == 0;
}

}  // namespace

std::vector<TtyLine> list_tty_lines(const std::string& folder) {
  std::vector<TtyLine> lines;
  std::error_code error;
  // A folder that cannot be listed counts as empty.
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool named = begins(name, "spidar");
    if (named || begins(name, "ttyUSB") || begins(name, "ttyACM"))
      lines.push_back({entry->path().string(), named});
  }
  std::sort(lines.begin(), lines.end(),
            [](const TtyLine& a, const TtyLine& b) { return a.path < b.path; });
  return lines;
}

}  // namespace spidar
