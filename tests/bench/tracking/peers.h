// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Ways of following points, for comparison. Except for make_paper(), they use OpenCV directly,
/// with its defaults where it has some, and do not detect cuts.
#pragma once

#include <memory>

#include "core/tracking/tracker.h"

namespace spidar::bench {

/// Follows points through a sequence of frames of one size. The ids of tracks mean nothing.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Compares `frame` with the previous one. The result is valid until the next call.
  virtual const TrackedFrame& track(const ImageView& frame) = 0;

  /// The next frame is the first one.
  virtual void restart() = 0;
};

/// The tracker of motion=mean.
std::unique_ptr<Peer> make_paper();

/// The obvious wiring: a frame converted from BGR, 200 Shi–Tomasi points of it, Lucas–Kanade with
/// windows of 21×21 px and 3 levels at full size.
std::unique_ptr<Peer> make_naive();

/// Flow of every pixel at a width of 480 px, taken at every 16th of them.
std::unique_ptr<Peer> make_dis_ultrafast();

}  // namespace spidar::bench
