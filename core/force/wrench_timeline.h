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
class SPIDAR_API WrenchTimeline {
 public:
  static constexpr size_t kCapacity = 64;

  /// Times must rise; one that does not is refused (false). When full, the oldest is forgotten.
  bool push(const TimedWrench& entry) noexcept;

  /// Times may be asked in any order.
  TimelineResult at(int64_t time_ns) const noexcept;

  void clear() noexcept { count_ = 0; }
  size_t size() const noexcept { return count_; }

 private:
  const TimedWrench& entry(size_t i) const noexcept { return entries_[(first_ + i) % kCapacity]; }

  std::array<TimedWrench, kCapacity> entries_{};
  size_t first_ = 0;
  size_t count_ = 0;
};

}  // namespace spidar
