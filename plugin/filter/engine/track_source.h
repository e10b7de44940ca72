// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track that is rendered in place of what a video's frames would give.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/analysis/frame.h"
#include "core/wrench.h"
#include "plugin/filter/engine/passing_frame.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/frame/frame_report.h"
#include "plugin/output/haptic_output.h"
#include "plugin/output/no_force.h"
#include "plugin/timing/loop_queue.h"
#include "plugin/tracks/read_ahead.h"

namespace spidar::filter {

/// Gives the blocks of a track that are due, with their running times.
class TrackReplay {
 public:
  /// The samples of a frame go on for this long after its end, because the next one may be late.
  static constexpr int64_t kMargin_ns = 60'000'000;
  /// The longest time that a frame waits for its samples: after a seek, or where they are read
  /// slowly for the first time.
  static constexpr std::chrono::seconds kLongestWait{1};

  /// Null for no track.
  void set_track(std::shared_ptr<ReadAhead> track);
  bool has_track() const { return track_ != nullptr; }

  /// Gives the samples that are rendered while the frame is shown and were not given before, at the
  /// running time of the sink. In another epoch, at another rate and after a gap, it begins with
  /// the block that the frame is in.
  void play(const FrameStamp& frame, const std::function<void(const TrackBlock&)>& give);

  /// The largest wrench of the track while the frame of the last play() is shown; rest where it has
  /// none.
  Wrench largest(const FrameStamp& frame) const;

 private:
  void cover(int64_t from_ns, int64_t to_ns, bool backwards);
  void jump(int64_t time_ns);
  bool append();
  void append_until(int64_t time_ns);
  void prepend(int64_t from_ns);
  void clear_beyond(int64_t from_ns, int64_t to_ns);

  std::shared_ptr<ReadAhead> track_;
  // All blocks that end after begin_ns_ and begin before end_ns_.
  std::deque<TrackBlock> window_;
  int64_t begin_ns_ = 0, end_ns_ = 0;
  bool continues_ = true;  ///< the next block of track_ is the one behind the window
  bool late_ = false;      ///< no more frames wait until a block has come
  std::optional<uint32_t> epoch_;
  double rate_ = 1;
  int64_t expected_ns_ = 0;  ///< stream time of the next frame
  int64_t given_ns_ = 0;     ///< end of what was given; backwards, its beginning
};

class TrackSource {
 public:
  /// All outlive this. `samples` takes those of the track; `times` knows when
  /// the sink shows a frame.
  TrackSource(const HapticOutput& output, LoopQueue<TrackBlock>& samples,
              const WrenchBacklog& times, NoForceWatch& no_force, ReliefStream& reliefs)
      : output_(output), samples_(samples), times_(times), no_force_(no_force), reliefs_(reliefs) {}

  /// The samples of `track`, from the file `path`, are rendered, and frames are not analysed; null:
  /// frames are analysed again. What was given of the previous track is still rendered: its frames
  /// are on their way to the screen.
  void set_track(std::shared_ptr<ReadAhead> track, const std::string& path = {});
  bool has_track() const { return replay_.has_track(); }
  /// The file of the track; empty: there is none. Any thread.
  std::string path() const;
  /// The number of frames since set_track(). Any thread.
  uint64_t frames() const { return frames_; }

  /// The report's wrench is the largest of the track while the frame is shown.
  void process(const PassingFrame& frame, FrameReport& report);
  void pass_gap(const FrameStamp& stamp);

 private:
  void play(const FrameStamp& stamp, FrameReport& report);

  const HapticOutput& output_;
  LoopQueue<TrackBlock>& samples_;
  const WrenchBacklog& times_;
  NoForceWatch& no_force_;
  ReliefStream& reliefs_;
  TrackReplay replay_;
  mutable std::mutex path_mutex_;  ///< guards path_
  std::shared_ptr<const std::string> path_;
  std::atomic<uint64_t> frames_{0};
};

}  // namespace spidar::filter
