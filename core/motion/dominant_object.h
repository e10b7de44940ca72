/// The object that the hand follows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/motion/objects.h"

namespace spidar {

/// Stays with an object until it dies, or until another one has been clearly more prominent
/// (kClearly times) for kTakesOver_s: the hand does not jump between objects.
class SPIDAR_API DominantObject {
 public:
  /// One of `objects`, the most prominent one to begin with; nothing while there are none. Call it
  /// once a frame. `interval_s` is the time since the frame before.
  const MovingObject* choose(const std::vector<MovingObject>& objects, double interval_s);

  void reset() { *this = DominantObject(); }

  static constexpr double kClearly = 1.5;
  static constexpr double kTakesOver_s = 0.3;

 private:
  uint32_t id_ = 0;  ///< 0: none
  double outshone_s_ = 0;
};

}  // namespace spidar
