// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws pictures with gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Runs a gnuplot script of this folder; `variables` are its strings by name. Throws
/// std::runtime_error when gnuplot is missing or reports an error.
void run_gnuplot(const std::string& script,
                 const std::vector<std::pair<std::string, std::string>>& variables);
