// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pictures that gnuplot draws.
#pragma once

#include <string>

#include "spidar/part_file.h"

namespace spidar::tools {

/// Runs gnuplot once on `script`, which sets its terminal to a kind of PNG, has its data in it and
/// does not set an output, and writes the picture into `picture`. Throws std::runtime_error, which
/// says why there is none: gnuplot is missing or reports an error, or the file cannot be written.
void draw_with_gnuplot(const std::string& script, const PartFile& picture);

/// `text` as a string literal of a script.
std::string gnuplot_string(const std::string& text);

}  // namespace spidar::tools
