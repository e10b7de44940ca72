// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/folders.h"

#include <array>
#include <cstdlib>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <pwd.h>
#include <sys/auxv.h>
#include <system_error>
#include <unistd.h>

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

const char* own_program() noexcept {
  constexpr const char* kByKernel = "/proc/self/exe";
  const bool has_proc = access(kByKernel, F_OK) == 0;
  return has_proc ? kByKernel : reinterpret_cast<const char*>(getauxval(AT_EXECFN));
}

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
