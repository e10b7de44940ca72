// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is found in a frame before anything is chosen to be felt.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/background.h"
#include "core/motion/image_motion.h"
#include "core/motion/moving_object.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// What a frame shows, compared with the picture before.
enum class Shown : uint8_t {
  kFirst,    ///< there is nothing to compare with
  kWaiting,  ///< the same picture, and the motion may go on
  kSame,     ///< the same picture, which is at rest
  kAlike,    ///< the same picture apart from the noise of coding
  kOther,    ///< another picture
};

struct MeasuredFrame {
  Shown shown = Shown::kFirst;
  /// Nothing before counts: after a seek or a discontinuity, unlike after a cut in the picture.
  bool anew = false;
  // Of a frame that waits, what follows is that of the picture before.
  int width = 0;  ///< px
  int height = 0;
  int features = 0;          ///< points looked for in the next frame
  int64_t interval_ns = 0;   ///< the time in which the motion happened; 0 with kFirst
  int64_t shown_for_ns = 0;  ///< see Cadence::Step
  /// With motion=mean the rest is empty, and this one is zero with all others.
  ImageMotion mean;
  std::optional<Background> background;  ///< nothing with kFirst
  int votes = 0;                         ///< displacements that the background was found from
  std::vector<MovingObject> objects;     ///< ordered by id
  uint32_t dominant = 0;                 ///< id of the object that motion=object feels; 0: none
  /// Not copied, valid until the next frame is measured; null where there are none.
  const std::vector<Track>* tracks = nullptr;
};

}  // namespace spidar
