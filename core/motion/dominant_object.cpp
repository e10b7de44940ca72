// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/dominant_object.h"

#include <algorithm>

namespace spidar {
namespace {

/// Memory for the objects of two frames, see ObjectTracker::kMostObjects.
constexpr size_t kMostRivals = 32;

}  // namespace

DominantObject::DominantObject() {
  rivals_.reserve(kMostRivals);
}

void DominantObject::reset() {
  id_ = 0;
  rivals_.clear();
}

/// Updates the means. Of the objects that are not in the list any more, only the one that is
/// followed is remembered.
void DominantObject::gather(const std::vector<MovingObject>& objects, double interval_s) {
  for (Rival& rival : rivals_) rival.now = nullptr;
  for (const MovingObject& object : objects) {
    const auto known = std::find_if(rivals_.begin(), rivals_.end(),
                                    [&](const Rival& rival) { return rival.id == object.id; });
    if (known == rivals_.end()) {
      rivals_.push_back({object.id, 0, &object});
    } else {
      known->now = &object;
    }
  }
  rivals_.erase(
      std::remove_if(rivals_.begin(), rivals_.end(),
                     [this](const Rival& rival) { return !rival.now && rival.id != id_; }),
      rivals_.end());
  const double newest = std::min(1.0, interval_s / kMean_s);
  for (Rival& rival : rivals_) {
    const double prominence = rival.now ? rival.now->prominence : 0;
    rival.prominence += newest * (prominence - rival.prominence);
  }
}

const MovingObject* DominantObject::choose(const std::vector<MovingObject>& objects,
                                           double interval_s) {
  gather(objects, interval_s);
  const Rival* best = nullptr;
  double most = 0;
  for (const Rival& rival : rivals_) {
    const bool is_followed = rival.id == id_;
    if (!is_followed && rival.now->prominence == 0) continue;
    const double prominence = rival.prominence * (is_followed ? kClearly : 1);
    if (prominence <= most) continue;
    best = &rival;
    most = prominence;
  }
  id_ = best ? best->id : 0;
  return best ? best->now : nullptr;
}

}  // namespace spidar
