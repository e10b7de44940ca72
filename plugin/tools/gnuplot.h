// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "spidar/part_file.h"

namespace spidar::tools {

/// Runs gnuplot on `script` and writes the plot to `picture`. The script selects a PNG terminal and
/// contains its data; it does not set an output. Throws std::runtime_error when gnuplot is missing
/// or reports an error, or when the file cannot be written.
void draw_with_gnuplot(const std::string& script, const PartFile& picture);

/// Returns `text` as a quoted gnuplot string.
std::string gnuplot_string(const std::string& text);

}  // namespace spidar::tools
