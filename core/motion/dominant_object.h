// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The object that the hand follows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/objects.h"

namespace spidar {

/// Stays with an object until another one is clearly more prominent (kClearly times), so that the
/// force does not jump between similar objects.
class DominantObject {
 public:
  /// Returns one of `objects`, at first the most prominent one; null when there are none. Call this
  /// once for each frame.
  const MovingObject* choose(const std::vector<MovingObject>& objects);

  void reset() { id_ = 0; }

  static constexpr double kClearly = 2;

 private:
  uint32_t id_ = 0;  ///< 0: none
};

}  // namespace spidar
