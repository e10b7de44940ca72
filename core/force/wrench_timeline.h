// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/history.h"
#include "core/wrench.h"

namespace spidar {

/// The wrench of one frame, and when it is rendered.
struct TimedWrench {
  int64_t time_ns = 0;  ///< running time at which the frame is shown
  /// How long after `time_ns` the wrench holds if no later frame follows; then it expires.
  int64_t hold_ns = 0;
  Wrench wrench;
  /// Whether the frame repeats the previous picture, whose wrench continues from `time_ns` for
  /// `hold_ns`. `wrench` is equal to the wrench of that picture, for a timeline that has forgotten
  /// its frame.
  bool repeated = false;
  /// How long before the frame the wrench applies: a motion that was measured between two pictures
  /// belongs to the time halfway between them.
  int64_t before_ns = 0;

  int64_t motion_ns() const noexcept { return time_ns - before_ns; }
};

enum class Found {
  kNothing,       ///< empty, or before the first frame: wrench is zero
  kExact,         ///< at the time of a frame
  kInterpolated,  ///< between two frames
  kHeld,          ///< after the last frame, within its hold time
  kExpired,       ///< after the hold time: the last wrench, for a ramp to zero
};

struct TimelineResult {
  Wrench wrench;
  Found found = Found::kNothing;
  int64_t frame_time_ns = INT64_MIN;  ///< of the newest frame at or before the queried time
  int64_t late_ns = 0;                ///< how late the wrench of the newest frame is reached
};

/// A short memory of timed wrenches. Interpolates, never extrapolates. Fixed size, no allocation.
///
/// A cubic Hermite curve joins two wrenches. The curve is exact at their times and has a continuous
/// slope there. Each component only rises or only falls, and so stays between its two values. If
/// the frame after a frame is known when the curve towards that frame begins, the slope at the
/// frame is that of M. Steffen, "A simple method for monotonic interpolation in one dimension",
/// Astronomy and Astrophysics 239 (1990), equation 11. Otherwise the slope is zero: to wait would
/// cause a delay, and any other slope could overshoot the wrench of the following frame.
///
/// A gap is an interval without frames that is long enough to ramp to zero and back. In a gap, a
/// still picture gives no force: the wrench holds and expires as if the next frame were unknown,
/// and rises from zero to the wrench of the next frame before that frame is due.
class WrenchTimeline {
 public:
  static constexpr size_t kCapacity = 64;
  /// If a frame becomes known late, less than approach_after() before its motion, the curve reaches
  /// it approach_after() after that, because a step would be felt as a knock. From zero and to
  /// zero, the approach takes kApproach_ns.
  static constexpr int64_t kApproach_ns = 15'000'000;
  /// The duration of an approach as a fraction of the interval between two frames: the less often
  /// pictures change, the larger is the change of the force, and the longer it must take. A force
  /// that changes during this fraction of the time has 1 / √kApproachFraction = 1.49 times the rms
  /// step of a force that changes all the time.
  static constexpr double kApproachFraction = 0.45;
  /// No frame is reached later than this after its time, unless it became known too late. People
  /// notice a delay of touch from 50 ms on.
  static constexpr int64_t kLatest_ns = 30'000'000;
  /// The duration of an approach: kApproachFraction of the interval since the previous frame; at
  /// least kApproach_ns, or the interval where that is shorter.
  static int64_t approach_after(int64_t interval_ns) noexcept;
  /// The longest time for which a frame should be held. The caller chooses TimedWrench::hold_ns,
  /// which this does not limit.
  static constexpr int64_t kLongestHold_ns = 100'000'000;
  /// TimedWrench::hold_ns of a frame that comes `interval_ns` after the previous one, when no later
  /// frame is known (live): until the next one is due, and a little longer because it may be late.
  /// With SafetyLimits::ramp_s the force is zero 50 ms after a missing frame, and at any frame rate
  /// from 11/s on it does not dip between two frames.
  static constexpr int64_t hold_after(int64_t interval_ns) noexcept {
    constexpr int64_t kLate_ns = 10'000'000;
    if (interval_ns <= 0) return 0;
    return interval_ns < kLongestHold_ns - kLate_ns ? interval_ns + kLate_ns : kLongestHold_ns;
  }
  /// The time from a full wrench to zero when it has expired, and from zero to a full one after a
  /// gap. SafetyLimits::ramp_s is the same.
  static constexpr int64_t kRamp_ns = 40'000'000;

  /// Returns false, and ignores the entry, when its time is not later than that of the last one. A
  /// motion before the last frame is moved to just after that frame, and one across a gap to the
  /// time of its own frame. A repeated frame does not shape the curve, which runs from the frame
  /// before it to the next different one; it only prolongs the hold of the previous frame, unless
  /// that has expired. When the timeline is full, it drops the oldest entry.
  ///
  /// The curve never changes before the time of the last at(), neither in value nor in slope. A
  /// late frame therefore fades in from that time, over the curve without that frame; when
  /// everything has expired by then, it applies at once.
  bool push(const TimedWrench& entry) noexcept;

  /// Times may be passed in any order; the last one passed is the present.
  TimelineResult at(int64_t time_ns) noexcept;

  void clear() noexcept {
    segments_.clear();
    present_ns_ = INT64_MIN;
  }
  size_t size() const noexcept { return segments_.size(); }
  size_t size_after(int64_t time_ns) const noexcept;

 private:
  /// The part of the curve that ends in a frame. A segment starts from the previous segment, which
  /// has usually reached its own frame by then. The segment of a late frame starts before that, and
  /// bends away from the previous segment. After a gap, a segment starts from zero.
  struct Segment {
    TimedWrench frame;
    int64_t from_ns = 0;
    int64_t to_ns = 0;  ///< frame.motion_ns(), or later
    Wrench from_slope;  ///< N/s and Nm/s
    Wrench to_slope;
    bool from_rest = false;
  };

  int64_t soonest(const TimedWrench& before, const TimedWrench& added) const noexcept;
  /// Chooses when the segment to a newly known frame begins and ends.
  Segment segment_to(const TimedWrench& added) noexcept;
  /// Sets the slope at the last frame, which depends on the `next` one, unless the segment to the
  /// last frame has already begun.
  void join_smoothly(Segment& next) noexcept;
  /// The wrench in the segment of this age or, after the segment, that of its frame.
  Wrench value(size_t age, int64_t time_ns) const noexcept;

  History<Segment, kCapacity> segments_;
  int64_t present_ns_ = INT64_MIN;  ///< the time of the last at(); INT64_MIN: none yet
};

}  // namespace spidar
