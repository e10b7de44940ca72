// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where in the pictures of a film the object is that is felt.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace spidar::tools {

/// In one frame.
struct FeltBox {
  int64_t stream_ns = 0;
  /// Left, top, right and bottom, as fractions of the picture as it is shown; all 0 where none is
  /// known.
  std::array<double, 4> edges{};

  bool is_known() const { return edges[2] > edges[0]; }
};

/// Of each frame, as spidarmotion measures it with `settings`, see RecordProperties. Throws
/// std::runtime_error, without the name of the film, when it cannot be played to its end, or the
/// settings are not those of a track.
std::vector<FeltBox> find_felt_boxes(const std::string& film, const std::string& settings);

}  // namespace spidar::tools
