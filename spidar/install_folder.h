// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where this program, plugin or library was installed, which need not be where it was built for.
#pragma once

#include <filesystem>
#include <string>

namespace spidar {

/// The file from which this code was loaded, a program or a library; empty when the system does not
/// tell.
std::filesystem::path own_file();

/// The folder that `file` is installed below, when it lies in that folder's folder for libraries,
/// plugins of GStreamer, or programs; empty when it lies anywhere else, as in a build folder.
std::filesystem::path prefix_of(const std::filesystem::path& file);

/// `below`, relative to the prefix, where this code is installed; where it was to be installed when
/// the code is not installed. `below` may be absolute, and then is the result.
std::filesystem::path installed(const std::string& below);

}  // namespace spidar
