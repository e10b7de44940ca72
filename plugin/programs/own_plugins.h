// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <vector>

namespace spidar {

/// Makes GStreamer find the plugins `names` of this version, in this process and in those that it
/// starts: adds the folder of the program, as in a build folder, or the one in which the plugins
/// were installed, if GStreamer searches neither. Returns an empty string, or what to do when the
/// plugins are missing. Call this after gst_init().
std::string find_own_plugins(const std::vector<std::string>& names);

}  // namespace spidar
