// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What `spidartrack info` prints about an analysis.
#pragma once

#include <string>

namespace spidar {

/// Prints frames, duration, settings and objects of the analysis `path`, as JSON if `json` is set.
/// Throws std::runtime_error when it cannot be read.
void print_analysis_info(const std::string& path, bool json);

}  // namespace spidar
