// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <filesystem>
#include <string>

#include <glib.h>

namespace spidar::tracks {

/// Returns the name with each letter and its accents as one character (Unicode's form NFC). Some
/// systems and archives write names decomposed (NFD), which file systems distinguish. A name that
/// is not UTF-8 stays as it is.
inline std::string composed(const std::string& name) {
  if (g_str_is_ascii(name.c_str())) return name;
  g_autofree gchar* normal =
      g_utf8_normalize(name.c_str(), static_cast<gssize>(name.size()), G_NORMALIZE_NFC);
  return normal ? normal : name;
}

/// Returns the file or folder of this path, or of one that differs only in the form of its names;
/// empty when there is none.
inline std::string existing(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) return path.string();
  if (g_str_is_ascii(path.c_str()) || path.filename().empty()) return {};
  const bool has_parent = path.has_parent_path();
  const std::string folder = has_parent ? existing(path.parent_path()) : ".";
  if (folder.empty()) return {};
  const std::string wanted = composed(path.filename().string());
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    const std::filesystem::path name = at->path().filename();
    if (composed(name.string()) == wanted) return has_parent ? at->path().string() : name.string();
  }
  return {};
}

}  // namespace spidar::tracks
