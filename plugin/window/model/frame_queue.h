// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames that have passed the element and are not on the screen yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "plugin/window/model/frame_feed.h"

namespace spidar {

/// The element sees a frame before the sink shows it, and the grip feels it when the sink does:
/// what a window draws beside the grip waits here until then. Window thread.
class FrameQueue {
 public:
  /// With more of them, as between the element and a sink with a long queue, the oldest is shown
  /// although it is not on the screen yet.
  static constexpr size_t kMost = 8;

  /// Takes what has come. An earlier running time than before is another stream, or a seek: all
  /// that waits is forgotten.
  void fill(FrameFeed& feed);
  /// Fills in the newest frame that is on the screen at this running time; without one, while
  /// nothing is felt, the newest of all. False when there is no other than before.
  bool show(std::optional<int64_t> running_ns, PictureCopy& picture, FrameFacts& facts);

 private:
  struct Frame {
    PictureCopy picture;
    FrameFacts facts;
  };
  void drop_oldest();

  std::deque<std::unique_ptr<Frame>> waiting_;
  std::unique_ptr<Frame> spare_;  ///< whose memory is used again
};

}  // namespace spidar
