// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the element does with frames and time, without GObject.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include <gst/video/video.h>

#include "plugin/filter/engine/frame_touch.h"
#include "plugin/filter/engine/live_source.h"
#include "plugin/filter/engine/stream_orientation.h"
#include "plugin/filter/engine/track_source.h"
#include "plugin/filter/reports/frame_trace.h"
#include "plugin/filter/reports/motion_stats.h"
#include "plugin/filter/reports/no_force_watch.h"
#include "plugin/frame/frame_report.h"
#include "plugin/output/haptic_output.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/timing/wrench_backlog.h"

namespace spidar {

/// Source of wrenches, trace and haptic session of one element. Methods are grouped by the thread
/// they belong to; what they share is locked here.
class MotionEngine {
 public:
  explicit MotionEngine(GstElement* element)
      : output_(element, [this] {
          schedule_.forward_waiting();
          track_samples_.forward_waiting();
        }) {}

  /// The device and where playback is.
  HapticOutput& output() { return output_; }
  const HapticOutput& output() const { return output_; }

  // --- state changes

  /// Opens the device. Throws ProfileError, DeviceError, std::runtime_error. Empty, or why the
  /// haptic trace cannot be written: the device works without it.
  std::string open(const MotionProperties& properties);
  /// Motors to rest, device closed.
  void close();
  /// Begins a stream. Empty, or why the trace cannot be written.
  std::string start(const std::string& trace_path);
  /// Ends it. What became of the rows of the trace.
  LineWriter::Status stop();

  // --- any thread

  /// The force ramps to rest at once and stays there until frames come after set_muted(false).
  void set_muted(bool muted);
  /// What was scheduled is forgotten at once, and so is what can be touched.
  void flush();
  /// There is nothing to touch any more: the force of the contact ends at once.
  void stop_touching() { touch_.forget(); }
  /// The sink shows what comes `multiplier` times as fast from this moment on, see InstantRate.
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// The sink has stepped over so much of running time: it shows what follows as much earlier.
  void skip(GstClockTime duration);
  GstStructure* stats() const;
  /// Frames that were analysed since the stream began.
  uint64_t frames() const { return stats_.frames(); }
  /// What has kept the force from being felt in the last second of what is on the screen: the
  /// film's reason if it has one, and else the device's.
  NoForceReason no_force_reason() const;

  // --- streaming thread

  /// Another stream begins: its frames are shown as they are until a tag says otherwise.
  void begin_stream();
  /// Tags that no element upstream has followed.
  void take_tags(const GstTagList* tags);
  /// How frames are turned before they are shown. What is felt is turned like them.
  const Orientation& turn() const { return turn_; }
  /// Frames are not analysed: the samples of this track, of the file `path`, are felt. Null: they
  /// are again.
  void set_track(std::shared_ptr<ReadAhead> track, const std::string& path = {});
  /// Valid until the next call. What is only shown of a frame is not filled in yet.
  FrameReport& process(const PassingFrame& frame);
  /// The next frame has nothing to do with the one before.
  void restart() { live_.restart(); }
  /// Running time begins anew: after a flush.
  void restart_timing();
  /// A sink that has skipped something is in time with the segment again.
  void begin_segment();
  /// See LiveSource::begin_gap().
  void begin_gap(GstClockTime running_time) { live_.begin_gap(running_time); }
  /// In place of a frame that has no picture.
  void pass_gap(GstBuffer* buffer, const GstSegment& segment);
  /// Nothing more comes.
  void end_of_stream() {
    live_.end_of_stream();
    no_force_watch_.end();
  }
  /// Where the grip points at the picture as it is shown; nothing while no device runs.
  std::optional<Eigen::Vector2d> grip_position() const { return touch_.grip_position(); }

 private:
  /// When the sink shows a frame, and where it is in the film.
  struct FrameTimes {
    int64_t running_ns = 0, stream_ns = 0;
  };
  std::optional<FrameTimes> times_of(const PassingFrame& frame);

  // These outlive the output's thread, which forwards what waits.
  WrenchBacklog schedule_;
  BlockQueue track_samples_;
  NoForceWatch no_force_watch_;
  Orientation turn_;
  FrameTouch touch_{output_};
  LiveSource live_{schedule_, no_force_watch_, touch_, turn_};
  TrackSource track_{output_, track_samples_, schedule_, no_force_watch_, touch_, turn_};
  std::mutex skip_mutex_;  // what is skipped reaches schedule and output in the same order
  HapticOutput output_;
  // Streaming thread.
  WrenchSource* source_ = &live_;
  StreamOrientation orientation_;
  FrameTrace trace_;
  FrameReport report_;

  MotionStats stats_;
};

}  // namespace spidar
