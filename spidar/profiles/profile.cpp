// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/profiles/profile.h"

#include <set>

#include "spidar/folders.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/whole_file.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".toml";
constexpr size_t kMax_bytes = 1 << 20;  // a profile has a few kilobytes

std::vector<fs::path> search_path() {
  std::vector<fs::path> folders = listed_folders("SPIDAR_PROFILE_PATH");
  folders.push_back(installed(SPIDAR_PROFILE_DIR));
  return folders;
}

bool is_path(const std::string& name_or_path) {
  return name_or_path.find('/') != std::string::npos ||
         fs::path(name_or_path).extension() == kEnding;
}

Profile read_file(const fs::path& path) {
  std::string text;
  note_read(path);
  try {
    text = read_regular_file(path.string(), kMax_bytes);
  } catch (const std::runtime_error& error) {
    throw ProfileError(path.string() + ": " + error.what() + "; a profile is a small TOML file");
  }
  return parse_profile(text, path.string(), path.stem().string());
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? "none" : text;
}

}  // namespace

Profile load_profile(const std::string& name_or_path) {
  if (is_path(name_or_path)) return read_file(name_or_path);
  std::vector<std::string> searched;
  for (const fs::path& folder : search_path()) {
    const fs::path path = folder / (name_or_path + kEnding);
    std::error_code error;
    if (fs::exists(path, error)) return read_file(path);
    searched.push_back(folder.string());
  }
  const auto shipped = shipped_profiles().find(name_or_path);
  if (shipped != shipped_profiles().end()) {
    return parse_profile(shipped->second, name_or_path + kEnding, name_or_path);
  }
  throw ProfileError("unknown profile \"" + name_or_path + "\"; known are " +
                     joined(list_profiles()) + "; searched in " + joined(searched));
}

std::vector<std::string> list_profiles() {
  std::set<std::string> names;
  for (const auto& shipped : shipped_profiles()) names.insert(shipped.first);
  for (const fs::path& folder : search_path()) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (it->path().extension() == kEnding) names.insert(it->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace spidar
