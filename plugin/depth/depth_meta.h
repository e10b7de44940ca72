// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Attaches a depth image to a frame (gstspidardepthmeta.h reads it).
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Meaning of the depth samples.
struct DepthMeaning {
  bool disparity = false;   ///< larger samples are nearer
  double near_sample = -1;  ///< below 0: to be found by percentiles
  double far_sample = -1;   ///< below 0: to be found by percentiles
};

/// Call once per process before the other functions.
void register_depth_meta();

/// Attaches `depth` to `frame`, which must be writable, and replaces any earlier depth image. Takes
/// references to `depth` and `caps`; copies no samples.
void attach_depth_meta(GstBuffer* frame, GstBuffer* depth, GstCaps* caps, gint64 running_time_ns,
                       const DepthMeaning& meaning);

}  // namespace spidar
