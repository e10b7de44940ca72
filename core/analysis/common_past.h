// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// When what was before a cut in a film does not matter behind it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/analysis/measured_frame.h"
#include "core/motion/cadence.h"
#include "core/tracking/repeated_picture.h"

namespace spidar {

/// Two FrameMeters that begin at different frames of a film find the same behind a cut if nothing
/// that they keep across it differs. That is the rhythm of the film alone: the latest
/// Cadence::kPictures intervals between new pictures, and the latest RepeatedPicture::kFrames
/// changes from frame to frame. After so many that both have seen, theirs are equal.
class CommonPast {
 public:
  /// Both have seen the frame shown at `time_ns`, and found the same of it. `has_picture`: it was
  /// compared, and not only said to repeat the one before.
  void add(Shown shown, int64_t time_ns, bool has_picture) {
    const bool is_new = has_picture && shown != Shown::kWaiting && shown != Shown::kSame;
    // Frames are compared with the latest picture that was new.
    if (has_begun_) changes_ += has_picture;
    if (is_new) {
      const bool is_interval =
          shown == Shown::kOther && time_ns - picture_ns_ <= Cadence::kLongest_ns;
      if (has_begun_) intervals_ += is_interval;
      has_begun_ = true;
      picture_ns_ = time_ns;
    }
  }
  /// They disagree on a frame, or only one of them has seen it.
  void restart() { *this = CommonPast(); }
  /// Whether they find the same from the next cut on.
  bool is_enough() const {
    return changes_ >= RepeatedPicture::kFrames && intervals_ >= Cadence::kPictures;
  }

 private:
  bool has_begun_ = false;
  int64_t picture_ns_ = 0;
  size_t changes_ = 0;
  size_t intervals_ = 0;
};

}  // namespace spidar
