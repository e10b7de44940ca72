/// Wrenches with the time at which each is to be felt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/api.h"
#include "core/wrench.h"

namespace spidar {

/// A wrench for one frame.
struct TimedWrench {
  int64_t time_ns = 0;  ///< running time at which the frame is shown
  /// With no later frame known the wrench holds for this long, then it is expired.
  int64_t hold_ns = 0;
  Wrench wrench;
};

/// How a wrench was found.
enum class Found {
  kNothing,       ///< empty, or before the first frame: wrench is zero
  kExact,         ///< the time of a frame
  kInterpolated,  ///< between two frames
  kHeld,          ///< after the last frame, within its hold time
  kExpired,       ///< after that: the wrench is the last one, for a ramp to rest, not to be applied
};

struct TimelineResult {
  Wrench wrench;
  Found found = Found::kNothing;
  int64_t frame_time_ns = INT64_MIN;  ///< of the newest frame at or before the time asked for
};

/// A short memory of timed wrenches. Interpolates, never extrapolates. Fixed size, no allocation.
///
/// Between two frames runs a cubic Hermite curve: exact at the frames, its slope continuous there,
/// each component rising or falling only, and so never outside the two values. Slopes are those of
/// M. Steffen, "A simple method for monotonic interpolation in one dimension", Astronomy and
/// Astrophysics 239 (1990), equation 11, where the frame after is known by the time that the curve
/// towards a frame begins, and zero where it is not: waiting for it would be delay, and any other
/// slope could lead past what that frame turns out to be.
class SPIDAR_API WrenchTimeline {
 public:
  static constexpr size_t kCapacity = 64;

  /// Times must rise; one that does not is refused (false). When full, the oldest is forgotten.
  ///
  /// A frame that comes while the one before is already held is approached from the time asked for
  /// last, without a step: what has been felt does not change any more. Only one that is due by
  /// then is a step.
  bool push(const TimedWrench& entry) noexcept;

  /// Times may be asked in any order; the last one asked for is the present.
  TimelineResult at(int64_t time_ns) noexcept;

  void clear() noexcept {
    count_ = 0;
    present_ns_ = INT64_MIN;
  }
  size_t size() const noexcept { return count_; }

 private:
  struct Knot {
    TimedWrench timed;
    int64_t from_ns = 0;  ///< the curve to this frame begins here; before, the last one is held
    Wrench slope;         ///< N/s and Nm/s, at the frame
  };

  Knot& knot(size_t i) noexcept { return knots_[(first_ + i) % kCapacity]; }

  std::array<Knot, kCapacity> knots_{};
  size_t first_ = 0;
  size_t count_ = 0;
  int64_t present_ns_ = INT64_MIN;  // nothing was felt yet
};

}  // namespace spidar
