// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A track that is felt in place of what a video's frames would give.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include <gst/gst.h>

#include "plugin/track/block_schedule.h"
#include "plugin/track/track_loader.h"
#include "plugin/track/track_replay.h"

namespace spidar {

/// Methods are grouped by the thread they belong to.
class TrackPlayer {
 public:
  // --- any thread

  /// See BlockSchedule.
  void connect(HapticLoop* loop) { schedule_.connect(loop); }
  void hand_on() { schedule_.hand_on(); }
  void set_muted(bool muted) { schedule_.set_muted(muted); }
  /// What was given is forgotten at once.
  void forget() { schedule_.forget(); }
  /// Whose samples are felt; false: frames are to be analysed.
  bool active() const { return active_; }
  uint64_t frames() const { return frames_; }

  // --- streaming thread

  /// An empty one: frames are to be analysed from now on. What was given of the track before is
  /// felt nevertheless: its frames are on their way to the screen.
  void set_track(TrackFile track);
  /// The next frame has nothing to do with the one before.
  void restart() { replay_.restart(); }
  /// Gives the samples that belong to this frame, and returns the largest wrench of them.
  Wrench play(const FramePlace& frame);

 private:
  BlockSchedule schedule_;
  TrackReplay replay_;
  std::atomic<bool> active_{false};
  std::atomic<uint64_t> frames_{0};  // since set_track()
};

/// Where the video is with `frame`, of which the sink shows the beginning, or the end when it is
/// played backwards, at `running_ns`. Nothing when the segment does not show it.
std::optional<FramePlace> place_of(GstBuffer* frame, GstClockTime default_duration,
                                   const GstSegment& segment, int64_t running_ns,
                                   double rate_multiplier);

/// The track to be felt for the film that comes to the sink pad of `element`. Nothing when there is
/// none; a warning on the bus when it cannot be used, or is that of another film.
std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns);

}  // namespace spidar
