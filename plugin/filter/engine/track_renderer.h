// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
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

#include "core/wrench.h"
#include "plugin/filter/engine/haptic_feed.h"
#include "plugin/frame/frame_report.h"
#include "plugin/timing/frame_pacer.h"
#include "plugin/tracks/read_ahead.h"
#include "plugin/tracks/track_loader.h"

namespace spidar::filter {

/// Supplies the blocks of a haptic track when their frames pass, in running time. A track replaces
/// the analysis of frames.
class TrackReplay {
 public:
  /// The samples of a frame continue for this long after its end, because the next one may be late.
  static constexpr int64_t kMargin_ns = 60'000'000;
  /// The longest time that a frame waits for its samples: after a seek, or where they are read
  /// slowly for the first time.
  static constexpr std::chrono::seconds kLongestWait{1};

  void set_track(std::shared_ptr<ReadAhead> track);
  bool has_track() const { return track_ != nullptr; }

  /// Passes to `give`, in running time of the sink, the samples for the time in which the frame is
  /// shown that were not given before. In another epoch, at another rate and after a gap, starts
  /// with the block of the frame.
  void play(const FrameStamp& frame, const std::function<void(const TrackBlock&)>& give);

  /// The largest wrench of the track while the frame of the last play() is shown; zero if none.
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
  bool continues_ = true;  ///< the next block of track_ follows the window
  bool late_ = false;      ///< a block was late: do not wait again until one arrives
  std::optional<uint32_t> epoch_;
  double rate_ = 1;
  int64_t expected_ns_ = 0;  ///< stream time of the next frame
  int64_t given_ns_ = 0;     ///< the end of the given samples; backwards, their beginning
};

class TrackRenderer {
 public:
  /// `feed` must outlive this object.
  TrackRenderer(GstElement* element, HapticFeed& feed) : feed_(feed), felt_(element) {}

  /// Begins another film; `track` is the value of the property. Frames are analysed until
  /// use_loaded() finds the track. Samples already given for the previous film are still rendered,
  /// because its frames are still on their way to the screen.
  void begin_stream(const std::string& track, const std::string& film);
  /// Call this for each frame, which lasts `frame_ns`, before has_track(). `has_rules`: FeltTrack.
  void use_loaded(int64_t frame_ns, bool has_rules);
  /// Whether a track replaces the analysis of frames.
  bool has_track() const { return replay_.has_track(); }
  /// Returns the file of the track; empty if there is none. Any thread.
  std::string path() const;
  uint64_t frames() const { return frames_; }

  /// Renders the track for a frame. The report gets the largest wrench while the frame is shown.
  void process(FrameReport& report);
  void pass_gap(const FrameStamp& stamp);

  tracks::Loader loader;

 private:
  void set_track(std::shared_ptr<ReadAhead> track, const std::string& path = {});
  void play(const FrameStamp& stamp, FrameReport& report);

  HapticFeed& feed_;
  tracks::FeltTrack felt_;
  TrackReplay replay_;
  mutable std::mutex path_mutex_;
  std::shared_ptr<const std::string> path_;
  std::atomic<uint64_t> frames_{0};
};

}  // namespace spidar::filter
