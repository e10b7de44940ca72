// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <mutex>
#include <string>

#include <gst/video/video.h>

#include "core/fields.h"
#include "plugin/filter/bus_warnings.h"
#include "plugin/filter/choice/motion_choice.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/engine/film_renderer.h"
#include "plugin/filter/engine/haptic_feed.h"
#include "plugin/filter/engine/track_renderer.h"
#include "plugin/filter/reports/frame_trace.h"
#include "plugin/filter/reports/motion_stats.h"
#include "plugin/filter/spidar_motion.h"
#include "plugin/frame/frame_report.h"
#include "plugin/frame/stream_orientation.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/timing/step_watch.h"

namespace spidar::filter {

/// The state of an element `spidarmotion`: its settings, and the parts that process its frames and
/// events.
struct MotionState {
  explicit MotionState(GstElement* element);

  void describe(FieldSink& to) const;

  // --- streaming thread

  /// Call this when running time restarts: after a flush, and before a stream.
  void reset();
  /// Processes a frame with `frame_settings`. Returns report().
  const FrameReport& process(const GstVideoFrame& frame, const GstSegment& segment);
  const FrameReport& report() const { return report_; }
  /// Call this when the next frame does not continue the previous one: seek, new film, new rate.
  void begin_epoch() { ++epoch_; }
  /// Call this instead of process() for a frame without a picture.
  void pass_gap(GstBuffer* buffer, const GstSegment& segment);

  std::mutex setting;         ///< settings must reach the parts in the order in which they were set
  MotionProperties settings;  ///< object lock
  bool opened = false;        ///< object lock: READY or above
  UnreadMessages unread;
  gint window_changes = 0;  ///< atomic; the changes to which the window has not yet responded

  // Any thread.
  HapticFeed feed;
  MotionStats stats;
  TrackRenderer track;  ///< its functions for frames: streaming thread
  MotionChoice choice;
  MotionDisplay display;
  StepWatch steps;  ///< begin() and end() in state changes

  // Streaming thread.
  FrameSettings frame_settings;  ///< of the frame that passes
  StreamOrientation orientation;
  FilmRenderer film{feed};
  FrameTrace trace;
  std::string next_trace;  ///< the file of the trace, until it is opened; empty: none
  BusWarnings warnings;

 private:
  FrameReport report_of(const GstVideoFrame& frame, const GstSegment& segment);

  uint32_t epoch_ = 0;  ///< FrameStamp::epoch; streaming thread
  FrameReport report_;
};

}  // namespace spidar::filter

// The files of the element share this category.
GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);

struct _GstSpidarMotionFilter {
  GstVideoFilter parent;

  spidar::filter::MotionState* state;
};

/// Sets the functions that handle frames and events, for class initialisation.
void gst_spidar_motion_install_stream(GstSpidarMotionFilterClass* klass);
