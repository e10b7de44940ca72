// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The state of an element spidarmotion.
#pragma once

#include <mutex>
#include <string>

#include <gst/gst.h>
#include <gst/video/video.h>

#include "core/fields.h"
#include "plugin/filter/bus_warnings.h"
#include "plugin/filter/choice/motion_choice.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/engine/live_source.h"
#include "plugin/filter/engine/stream_orientation.h"
#include "plugin/filter/engine/track_source.h"
#include "plugin/filter/reports/frame_trace.h"
#include "plugin/filter/reports/motion_stats.h"
#include "plugin/filter/spidar_motion.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/frame/frame_report.h"
#include "plugin/output/haptic_output.h"
#include "plugin/output/no_force.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/timing/loop_queue.h"
#include "plugin/timing/step_watch.h"
#include "plugin/tracks/track_loader.h"

namespace spidar::filter {

/// The settings of an element, and the parts that its frames and events go through. Its functions
/// involve several of these parts.
struct MotionState {
  explicit MotionState(GstElement* element);

  // --- state changes

  /// Opens the device. Returns an empty string, or why the haptic trace cannot be written: the
  /// device works without it. Throws ProfileError, DeviceError, std::runtime_error.
  std::string open(const MotionProperties& properties);
  /// Brings the motors to rest and closes the device.
  void close();

  // --- any thread

  /// The force ramps to rest at once and stays there until frames come after set_muted(false).
  void set_muted(bool muted);
  /// Discards at once what was scheduled, and the surface that can be touched.
  void clear();
  /// From now on, the sink shows frames `multiplier` times as fast, see InstantRate::change().
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// The sink has stepped over `duration` of running time and shows later frames that much earlier.
  void skip(GstClockTime duration);
  /// Running time begins anew: after a flush, and before a stream. Streaming thread.
  void reset();
  /// The fields of `stats`.
  void describe(FieldSink& to) const;

  // --- streaming thread

  /// Processes a frame with `frame_settings`. Returns report().
  const FrameReport& process(const GstVideoFrame& frame, const GstSegment& segment);
  /// The report of the newest frame.
  const FrameReport& report() const { return report_; }
  /// The next frame does not continue the previous one: a seek, another film, another rate.
  void begin_epoch() { ++epoch_; }
  /// Called instead of process() for a frame without a picture.
  void pass_gap(GstBuffer* buffer, const GstSegment& segment);

  std::mutex setting;         ///< what is set reaches the parts in the order it was set
  MotionProperties settings;  ///< object lock
  bool opened = false;        ///< object lock: READY or above
  gint unread_messages = 0;   ///< atomic; posted, and not read by an application
  gint window_changes = 0;    ///< atomic; to which the window has not yet responded

  // Any thread. These outlive the output's thread, which forwards what waits.
  WrenchBacklog schedule;
  LoopQueue<TrackBlock> track_samples{kMaxBlocksWaiting};
  NoForceWatch no_force;
  ReliefStream reliefs;
  HapticOutput output;
  MotionStats stats;
  tracks::Loader loader;
  MotionChoice choice;
  MotionDisplay display;
  StepWatch steps;  ///< state changes

  // Streaming thread.
  FrameSettings frame_settings;  ///< of the frame that passes
  StreamOrientation orientation;
  LiveSource live{schedule, no_force, reliefs, output};
  TrackSource track{output, track_samples, schedule, no_force, reliefs};
  FrameTrace trace;
  tracks::FeltTrack felt;
  BusWarnings warnings;

 private:
  FrameReport report_of(const GstVideoFrame& frame, const GstSegment& segment);

  std::mutex skip_mutex_;  ///< what is skipped reaches schedule and output in the same order
  uint32_t epoch_ = 0;     ///< FrameStamp::epoch; streaming thread
  FrameReport report_;
};

}  // namespace spidar::filter

// Also shared by the files of the element.
GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);

struct _GstSpidarMotionFilter {
  GstVideoFilter parent;

  spidar::filter::MotionState* state;
};

/// Class initialisation: the functions that handle frames and events.
void gst_spidar_motion_install_stream(GstSpidarMotionFilterClass* klass);
