// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track that is felt in place of what a video's frames would give.
#pragma once

#include <atomic>
#include <cstdint>

#include "plugin/device/haptic_output.h"
#include "plugin/filter/engine/frame_touch.h"
#include "plugin/filter/engine/wrench_source.h"
#include "plugin/filter/reports/limit_watch.h"
#include "plugin/timing/wrench_schedule.h"
#include "plugin/tracks/block_schedule.h"
#include "plugin/tracks/track_replay.h"

namespace spidar {

class TrackSource : public WrenchSource {
 public:
  /// All are the engine's, and outlive this. `times` knows when the sink shows a frame.
  TrackSource(const HapticOutput& output, const WrenchSchedule& times, LimitWatch& limits,
              FrameTouch& touch)
      : output_(output), times_(times), limits_(limits), touch_(touch) {}

  /// What was given of the track before is felt nevertheless: its frames are on their way to the
  /// screen.
  void set_track(TrackFile track);
  bool has_track() const { return replay_.has_track(); }
  /// Since set_track(). Any thread.
  uint64_t frames() const { return frames_; }

  void connect(HapticLoop* loop) override { samples_.connect(loop); }
  void hand_on() override { samples_.hand_on(); }
  void set_muted(bool muted) override { samples_.set_muted(muted); }
  void forget() override { samples_.forget(); }
  void restart() override { replay_.restart(); }
  /// The report's wrench is the largest of the track while the frame is shown.
  bool take(const PassingFrame& frame, FrameReport& report) override;
  void pass_gap(GstBuffer* buffer, const GstSegment& segment, int64_t running_ns) override;

 private:
  void play(GstBuffer* buffer, GstClockTime default_duration, const GstSegment& segment,
            int64_t running_ns, FrameReport& report);

  const HapticOutput& output_;
  const WrenchSchedule& times_;
  LimitWatch& limits_;
  FrameTouch& touch_;
  BlockSchedule samples_;
  TrackReplay replay_;
  std::atomic<uint64_t> frames_{0};
};

}  // namespace spidar
