// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace spidar {

/// Returns the file from which this code was loaded, a program or a library; empty if unknown.
std::filesystem::path own_file();

/// Returns the prefix below which `file` is installed, if `file` lies in the prefix's folder for
/// libraries, GStreamer plugins or programs; empty for a file elsewhere, as in a build folder.
std::filesystem::path prefix_of(const std::filesystem::path& file);

/// Returns the path `below` under the prefix of this code or, if this code is not installed, under
/// the prefix of the build. An absolute `below` is returned as it is.
std::filesystem::path installed(const std::string& below);

/// Returns the folders that the environment variable `name` lists, separated by colons. A colon in
/// the name of an existing folder separates nothing: "/films/Ring: the first".
std::vector<std::filesystem::path> listed_folders(const char* name);

}  // namespace spidar
