// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What gives the wrenches of a stream.
#pragma once

#include <cstdint>

#include <gst/video/video.h>

#include "core/analysis/analyzer_settings.h"
#include "plugin/frame/frame_report.h"
#include "plugin/properties/motion_properties.h"

namespace spidar {

/// A frame that passes the element, and how it is to be felt.
struct PassingFrame {
  const GstVideoFrame& video;
  const GstSegment& segment;
  /// Its pointer is a position of the frame before it is turned.
  const AnalyzerSettings& settings;
  const TouchProperties& touch;
};

/// What of the settings is shown with the frame.
inline void set_shown(const PassingFrame& frame, const Orientation& turn, FrameReport& report) {
  report.visible = visible_part(frame.video);
  report.turn = turn;
  report.motion = frame.settings.motion;
  report.controller = frame.settings.controller;
  report.click = frame.settings.kept.click;
}

/// Either the analysis of the frames or a haptic track, chosen when the stream starts. Streaming
/// thread.
class WrenchSource {
 public:
  virtual ~WrenchSource() = default;

  /// Gives what is felt while the frame is shown, at `running_ns`, and fills in the report, but for
  /// the times of its frame. False when nothing of it can be felt, for `report.problem`.
  virtual bool take(const PassingFrame& frame, int64_t running_ns, FrameReport& report) = 0;
  /// The same of a frame that has no picture.
  virtual void pass_gap(GstBuffer* buffer, const GstSegment& segment, int64_t running_ns) = 0;
};

}  // namespace spidar
