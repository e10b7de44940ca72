// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "spidar/part_file.h"

namespace spidar::tools {

/// Runs gnuplot once on `script`, which sets its terminal to a kind of PNG, contains its data and
/// does not set an output, and writes the picture into `picture`. Throws std::runtime_error with
/// the reason: gnuplot is missing or reports an error, or the file cannot be written.
void draw_with_gnuplot(const std::string& script, const PartFile& picture);

/// `text` as a string literal of a script.
std::string gnuplot_string(const std::string& text);

}  // namespace spidar::tools
