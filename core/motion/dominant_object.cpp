// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/dominant_object.h"

#include <algorithm>

namespace spidar {

const MovingObject* DominantObject::choose(const std::vector<MovingObject>& objects) {
  const MovingObject* best = nullptr;
  double most = 0;
  for (const MovingObject& object : objects) {
    const double prominence = object.prominence * (object.id == id_ ? kClearly : 1);
    if (best && prominence <= most) continue;
    best = &object;
    most = prominence;
  }
  id_ = best ? best->id : 0;
  return best;
}

}  // namespace spidar
