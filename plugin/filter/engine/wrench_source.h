// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What gives the wrenches of a stream.
#pragma once

#include <cstdint>

#include <gst/video/video.h>

#include "core/analysis/analyzer_settings.h"
#include "plugin/filter/frame/frame_report.h"
#include "plugin/properties/motion_properties.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar {

/// A frame that passes the element, and how it is to be felt.
struct PassingFrame {
  const GstVideoFrame& video;
  const GstSegment& segment;
  /// Its pointer is a place of the frame before it is turned.
  const AnalyzerSettings& settings;
  const TouchProperties& touch;
};

/// Either the analysis of the frames or a haptic track, chosen when the stream starts. Methods are
/// grouped by the thread they belong to.
class WrenchSource {
 public:
  virtual ~WrenchSource() = default;

  // --- state changes

  /// `loop` outlives the connection; null ends it.
  virtual void connect(HapticLoop* loop) = 0;

  // --- any thread

  /// Gives the loop what it had no room for. To be called while playing, more often than every
  /// 100 ms.
  virtual void hand_on() = 0;
  /// What is given while muted is forgotten.
  virtual void set_muted(bool muted) = 0;
  /// Everything that was given so far.
  virtual void forget() = 0;

  // --- streaming thread

  /// The next frame has nothing to do with the one before.
  virtual void restart() = 0;
  /// Gives what is felt while the frame is shown, at `running_ns`, and fills in the report, but for
  /// the times of its frame. False when nothing of it can be felt, for `report.problem`.
  virtual bool take(const PassingFrame& frame, int64_t running_ns, FrameReport& report) = 0;
  /// The same of a frame that has no picture.
  virtual void pass_gap(GstBuffer* buffer, const GstSegment& segment, int64_t running_ns) = 0;
};

}  // namespace spidar
