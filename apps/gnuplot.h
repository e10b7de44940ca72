// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws pictures with gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Strings of a gnuplot script, by name.
using GnuplotStrings = std::vector<std::pair<std::string, std::string>>;

/// Runs a gnuplot script of this folder. `files` are the names of files that it reads and writes,
/// or empty; `texts` are its other strings. Throws std::runtime_error when gnuplot is missing or
/// reports an error, or when one of the files ends in .png and is not a whole picture.
void run_gnuplot(const std::string& script, const GnuplotStrings& files,
                 const GnuplotStrings& texts);
