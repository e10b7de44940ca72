// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The trackers that are compared. A new one is a line in pipelines.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/field/field_points.h"
#include "core/tracking/tracker.h"

namespace spidar::bench {

struct Pipeline {
  std::string name;         ///< as on the command line
  std::string description;  ///< as in the table
  /// False: ids are of one frame only, and the benchmark links them where a point appears next to
  /// where another one went.
  bool keeps_ids;
  std::function<std::unique_ptr<Tracker>()> make;
  /// Points that the motion of objects takes beside its field of blocks, instead of a tracker's.
  /// The tracks are then those points and the blocks that have none.
  std::optional<FieldPoints::Settings> own_points = std::nullopt;
};

const std::vector<Pipeline>& pipelines();

}  // namespace spidar::bench
