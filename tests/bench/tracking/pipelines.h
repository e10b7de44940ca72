// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The ways of finding motion that are compared. A new one is a line in pipelines.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/tracking/peers.h"

namespace spidar::bench {

struct Pipeline {
  std::string name;         ///< as on the command line
  std::string description;  ///< as in the table
  /// Follows points, from which only the mean motion is computed; empty for the field of blocks.
  std::function<std::unique_ptr<Peer>()> make;
};

const std::vector<Pipeline>& pipelines();

}  // namespace spidar::bench
