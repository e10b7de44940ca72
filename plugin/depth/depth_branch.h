// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The stream of depth, from its pad to the gate.
#pragma once

#include <atomic>

#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/depth/depth_gate.h"
#include "plugin/depth/depth_properties.h"

namespace spidar {

/// What a streaming thread knows of its frames.
struct VideoStream {
  GstSegment segment;
  GstVideoInfo info;

  /// Length of a frame by the frame rate, 0 where there is none.
  GstClockTime frame_ns() const;
  void reset();
};

/// Posts warnings and errors for `element`. All but images() belongs to the streaming thread.
class DepthBranch {
 public:
  DepthBranch(GstElement* element, DepthGate& gate) : element_(element), gate_(gate) { reset(); }

  /// Takes the buffer. Waits until there is room for it.
  GstFlowReturn add(GstBuffer* buffer);
  /// Leaves the event alone. FALSE for caps that cannot be used.
  gboolean take(GstEvent* event, const DepthProperties& properties);
  void reset();

  /// That have come.
  int images() const { return images_; }

 private:
  gboolean set_caps(GstCaps* caps, const DepthProperties& properties);
  void skip(GstEvent* gap);

  GstElement* element_;
  DepthGate& gate_;
  VideoStream stream_;
  std::unique_ptr<GstCaps, Unref> caps_;
  bool complained_ = false;  // that images have no timestamps
  std::atomic<int> images_{0};
};

}  // namespace spidar
