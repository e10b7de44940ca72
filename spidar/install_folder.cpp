// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/install_folder.h"

#include <cstdlib>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <sys/auxv.h>
#include <system_error>

#include "spidar/own_program.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// Returns `folder` without the suffix `end`; empty when `folder` does not end with it.
fs::path without_end(const fs::path& folder, const fs::path& end) {
  fs::path rest = folder;
  for (fs::path part = end; !part.empty(); part = part.parent_path()) {
    if (rest.filename() != part.filename()) return {};
    rest = rest.parent_path();
  }
  return rest;
}

}  // namespace

fs::path own_file() {
  Dl_info info{};
  void* extra = nullptr;
  // Any address within this code will do.
  void* here = reinterpret_cast<void*>(&prefix_of);
  if (!dladdr1(here, &info, &extra, RTLD_DL_LINKMAP) || !extra) return {};
  std::error_code error;
  // The main program has no name in the list of loaded files.
  const char* name = static_cast<link_map*>(extra)->l_name;
  return fs::canonical(name && *name ? name : own_program(), error);
}

fs::path prefix_of(const fs::path& file) {
  const fs::path libraries = SPIDAR_LIBDIR;
  for (const fs::path& end : {libraries / "gstreamer-1.0", libraries, fs::path(SPIDAR_BINDIR)}) {
    // A folder outside the prefix says nothing about the prefix.
    if (end.is_absolute()) continue;
    const fs::path prefix = without_end(file.parent_path(), end);
    if (!prefix.empty()) return prefix;
  }
  return {};
}

fs::path installed(const std::string& below) {
  const fs::path prefix = prefix_of(own_file());
  return (prefix.empty() ? fs::path(SPIDAR_PREFIX) : prefix) / below;
}

std::vector<fs::path> listed_folders(const char* name) {
  const char* const value = secure_getenv(name);
  std::vector<fs::path> folders;
  for (std::string rest = value ? value : ""; !rest.empty();) {
    std::error_code none;
    size_t end = rest.size();  // the longest entry that exists
    while (end != std::string::npos && !fs::is_directory(rest.substr(0, end), none)) {
      end = end == 0 ? std::string::npos : rest.rfind(':', end - 1);
    }
    if (end == std::string::npos) end = rest.find(':');  // no entry exists
    if (end != 0) folders.emplace_back(rest.substr(0, end));
    rest.erase(0, end == std::string::npos ? end : end + 1);
  }
  return folders;
}

}  // namespace spidar
