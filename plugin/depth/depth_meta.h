// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Attaches a depth image to a frame (gstspidardepthmeta.h reads it).
#pragma once

#include <gst/gst.h>

namespace spidar {

/// What the samples of depth mean.
struct DepthMeaning {
  bool disparity = false;   ///< larger samples are nearer
  double near_sample = -1;  ///< below 0: to be found by percentiles
  double far_sample = -1;   ///< below 0: to be found by percentiles
};

/// Once a process, before the first of the others.
void register_depth_meta();

/// `frame` has to be writable; a depth image that it had is replaced. References are taken to
/// `depth` and `caps`; no sample is copied.
void attach_depth_meta(GstBuffer* frame, GstBuffer* depth, GstCaps* caps, gint64 running_time_ns,
                       const DepthMeaning& meaning);

}  // namespace spidar
