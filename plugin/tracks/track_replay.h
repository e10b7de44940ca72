// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Plays a track that is in memory, frame by frame of the video that it belongs to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/wrench.h"
#include "plugin/tracks/track_file.h"

namespace spidar {

/// Where the video is.
struct FramePlace {
  int64_t stream_ns = 0;   ///< of what is to be seen first of the frame
  int64_t running_ns = 0;  ///< at which that is shown
  int64_t length_ns = 0;   ///< of stream time, for which the frame is shown
  double rate = 1;         ///< of stream time against running time; negative: backwards
};

/// Gives the blocks of a track whose time it is, with their running times.
class TrackReplay {
 public:
  /// So much longer than a frame is shown its samples are given: the next frame may be late.
  static constexpr int64_t kMargin_ns = 60'000'000;

  void set_track(TrackFile track) {
    track_ = std::move(track);
    restart();
  }
  bool has_track() const { return !track_.blocks.empty(); }

  /// The next frame has nothing to do with the one before.
  void restart() { follows_ = false; }

  /// Gives what is not yet given of the samples that are felt while the frame is shown. After a
  /// jump, or at another rate, it begins with the block that the frame is in.
  void play(const FramePlace& frame, const std::function<void(const TrackBlock&)>& give);

  /// The largest wrench of the track while the frame is shown; rest where it has none.
  Wrench largest(const FramePlace& frame) const;

 private:
  size_t block_at(int64_t stream_ns) const;
  TrackBlock timed(const TrackBlock& block, const FramePlace& frame) const;

  TrackFile track_;
  bool follows_ = false;
  double rate_ = 1;
  int64_t expected_ns_ = 0;  // stream time of the next frame
  // The next block to be given; backwards it is the one before this.
  size_t next_ = 0;
};

}  // namespace spidar
