#include "core/motion/dominant_object.h"

#include <algorithm>

namespace spidar {

const MovingObject* DominantObject::choose(const std::vector<MovingObject>& objects,
                                           double interval_s) {
  const auto most = std::max_element(
      objects.begin(), objects.end(),
      [](const MovingObject& a, const MovingObject& b) { return a.prominence < b.prominence; });
  if (most == objects.end()) {
    reset();
    return nullptr;
  }
  const auto held = std::find_if(objects.begin(), objects.end(),
                                 [this](const MovingObject& object) { return object.id == id_; });
  const bool outshone = held != objects.end() && most->prominence > kClearly * held->prominence;
  outshone_s_ = outshone ? outshone_s_ + interval_s : 0;
  if (held != objects.end() && outshone_s_ < kTakesOver_s) return &*held;
  id_ = most->id;
  outshone_s_ = 0;
  return &*most;
}

}  // namespace spidar
