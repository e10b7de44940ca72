/// The trackers that are compared. A new one is a line in pipelines.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/tracking/tracker.h"

namespace spidar::bench {

struct Pipeline {
  std::string name;         ///< as on the command line
  std::string description;  ///< as in the table
  /// False: ids are of one frame only, and the benchmark links them where a point appears next to
  /// where another one went.
  bool keeps_ids;
  std::function<std::unique_ptr<Tracker>()> make;
};

const std::vector<Pipeline>& pipelines();

}  // namespace spidar::bench
