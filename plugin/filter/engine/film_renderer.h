// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "core/analysis/motion_analyzer.h"
#include "core/analysis/square_pixel_resampler.h"
#include "plugin/filter/engine/haptic_feed.h"
#include "plugin/frame/frame_luma.h"
#include "plugin/frame/frame_report.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar::filter {

/// Returns the position in the shown picture at which the grip points; nothing if no device runs.
std::optional<Eigen::Vector2d> grip_position(const HapticOutput& output);

/// A frame that passes the element.
struct PassingFrame {
  const GstVideoFrame& video;
  const GstSegment& segment;
  const FrameSettings& settings;
};

/// Analyses the frames that pass. Streaming thread.
class FilmRenderer {
 public:
  /// `feed` must outlive this object.
  explicit FilmRenderer(HapticFeed& feed) : feed_(feed) {}

  void configure(const AnalyzerSettings& settings) { analyzer_.configure(settings); }

  /// Begins a run: the next frame is not compared with the previous one.
  void begin_run() { analyzer_.reset(); }
  /// Analyses the frame and schedules its force for the time at which it is shown. Fills in the
  /// report, apart from the times of the frame, or the fault that prevents the analysis.
  void process(const PassingFrame& frame, FrameReport& report);
  /// Call this instead of process() for a gap buffer. `turn` is the orientation for display.
  void pass_gap(const FrameStamp& stamp, const Orientation& turn);

  void begin_segment() { pacer_.begin_segment(); }
  /// Call this when running time restarts.
  void reset();
  /// Handles a gap event: there are no frames from `running_time` on. Frames that are still in the
  /// decoder may follow, because the demuxer's event overtakes them and may begin too early.
  void begin_gap(GstClockTime running_time);
  void end_of_stream();

 private:
  void follow(const FrameStamp& stamp);
  void schedule(const Frame& frame, const PacedTime& time, bool moved, const Wrench& shown);
  bool follows(const PassingFrame& frame, FrameReport& report);
  bool analyze(const PassingFrame& frame, const ImageView& luma, int64_t paced_ns,
               FrameReport& report);
  Wrench shown_wrench(const Frame& frame, const Orientation& turn) const;
  void end_gap(int64_t running_ns);
  void run_out(GstClockTime running_time);

  HapticFeed& feed_;
  FrameLuma luma_;
  SquarePixelResampler square_;
  MotionAnalyzer analyzer_;
  FramePacer pacer_;
  uint32_t epoch_ = 0;
  int64_t picture_ns_ = 0;         ///< when the picture of the newest frame was first shown
  std::optional<int64_t> gap_ns_;  ///< start of an announced gap, until a frame comes
  double motion_fraction_ = 1;     ///< for the newest frame's wrench
};

}  // namespace spidar::filter
