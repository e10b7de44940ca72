// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Folders: where this program, plugin or library is installed, which need not be the prefix it was
/// built for, and those that a variable lists.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace spidar {

/// The file from which this code was loaded, a program or a library; empty when the system does not
/// tell.
std::filesystem::path own_file();

/// The prefix below which `file` is installed, if it lies in the prefix's folder for libraries,
/// GStreamer plugins or programs; empty if it lies anywhere else, as in a build folder.
std::filesystem::path prefix_of(const std::filesystem::path& file);

/// The path `below` under the prefix of this code or, if it is not installed, under the prefix it
/// was built for. An absolute `below` is returned as it is.
std::filesystem::path installed(const std::string& below);

/// The folders that the environment variable `name` lists, separated by colons. A colon in the name
/// of a folder that is there separates nothing: "/films/Ring: the first".
std::vector<std::filesystem::path> listed_folders(const char* name);

}  // namespace spidar
