// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Command-line options.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace spidar::bench {

struct Options {
  std::vector<std::pair<int, int>> sizes = {{640, 360}, {1280, 720}};
  std::vector<std::string> cases;      ///< empty: all
  std::vector<std::string> pipelines;  ///< empty: all
  int scenes = 1;                      ///< pictures that each case is made from
  int rounds = 1;                      ///< times that each film is run through each pipeline
  std::string middlebury;              ///< folder; empty: left out
  std::string csv;                     ///< file; empty: none
};

/// Throws std::invalid_argument that says what is wrong with the arguments.
Options parse_options(int argc, const char* const* argv);

extern const char* const kUsage;

}  // namespace spidar::bench
