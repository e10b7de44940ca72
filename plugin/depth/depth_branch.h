// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Handles the depth stream from its pad to the gate.
#pragma once

#include <atomic>

#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/depth/depth_gate.h"
#include "plugin/depth/depth_properties.h"

namespace spidar {

/// Segment and format of a video stream.
struct VideoStream {
  GstSegment segment;
  GstVideoInfo info;

  /// Duration of a frame at the frame rate, 0 if the rate is unknown.
  GstClockTime frame_ns() const;
  void reset();
};

/// Posts warnings and errors for `element`. Only images() may be called outside the streaming
/// thread.
class DepthBranch {
 public:
  DepthBranch(GstElement* element, DepthGate& gate) : element_(element), gate_(gate) { reset(); }

  /// Takes ownership of the buffer. Blocks until there is room for it.
  GstFlowReturn add(GstBuffer* buffer);
  /// Handles an event without taking ownership. Returns FALSE for unusable caps.
  gboolean take(GstEvent* event, const DepthProperties& properties);
  void reset();

  /// Number of images received.
  int images() const { return images_; }

 private:
  gboolean set_caps(GstCaps* caps, const DepthProperties& properties);
  void skip(GstEvent* gap);

  GstElement* element_;
  DepthGate& gate_;
  VideoStream stream_;
  Ref<GstCaps> caps_;
  bool warned_ = false;  // about images without timestamps
  std::atomic<int> images_{0};
};

}  // namespace spidar
