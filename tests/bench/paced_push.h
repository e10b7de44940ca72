// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pushes prepared frames through an element, paced like a film.
#pragma once

#include <string>
#include <vector>

#include <gst/gst.h>

namespace spidar::bench {

enum class Content {
  kMoving,    ///< one frame after the other, to and fro
  kRepeated,  ///< each of these twice; only the second ones are measured
  kStill,     ///< the first one again and again
  kGap,       ///< the same, marked as without content
};

struct PushCost {
  // Of each frame, from the source's push until the sink has taken it, ms.
  std::vector<double> thread_ms;  ///< processor time of the streaming thread
  std::vector<double> wall_ms;
  /// Processor time of all other threads over the time that passed.
  double others = 0;
};

/// Pushes `count` frames of `frames`, after a few that do not count, through `filter`, a launch
/// line or empty, to a fakesink. Throws std::runtime_error when GStreamer refuses.
PushCost push_paced(const std::string& filter, GstCaps* caps, const std::vector<GstBuffer*>& frames,
                    Content content, int count, int rate_Hz);

}  // namespace spidar::bench
