// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/wrench_timeline.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// later − earlier, for earlier ≤ later. Unsigned, because the difference can exceed INT64_MAX.
uint64_t elapsed_ns(int64_t earlier_ns, int64_t later_ns) {
  return static_cast<uint64_t>(later_ns) - static_cast<uint64_t>(earlier_ns);
}

double elapsed_s(int64_t earlier_ns, int64_t later_ns) {
  return 1e-9 * static_cast<double>(elapsed_ns(earlier_ns, later_ns));
}

/// The slope of Steffen's monotone interpolation at the point where two segments meet, from their
/// slopes and durations; zero if it is not finite.
Eigen::Vector3d slope_between(const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                              double before_s, double after_s) {
  Eigen::Vector3d slope;
  for (int i = 0; i < 3; ++i) {
    const double a = before[i];
    const double b = after[i];
    const double parabola = (a * after_s + b * before_s) / (before_s + after_s);
    const double steepest = 2 * std::min({std::fabs(a), std::fabs(b), 0.5 * std::fabs(parabola)});
    const bool same_way = a * b > 0 && std::isfinite(steepest);
    slope[i] = same_way ? std::copysign(steepest, a) : 0;
  }
  return slope;
}

/// The slope at `b`, reached from `a` in `before_s` and left for `c` in `after_s`.
Wrench slope_between(const Wrench& a, const Wrench& b, const Wrench& c, double before_s,
                     double after_s) {
  const Wrench before = (1 / before_s) * (b - a);
  const Wrench after = (1 / after_s) * (c - b);
  return {slope_between(before.force_N, after.force_N, before_s, after_s),
          slope_between(before.torque_Nm, after.torque_Nm, before_s, after_s)};
}

bool has_expired(const TimedWrench& frame, int64_t time_ns) {
  const int64_t hold_ns = std::max<int64_t>(frame.hold_ns, 0);
  return time_ns > frame.time_ns &&
         elapsed_ns(frame.time_ns, time_ns) > static_cast<uint64_t>(hold_ns);
}

/// Prolongs the hold of `frame` to the end of the hold of `repeated`.
void hold_until(TimedWrench& frame, const TimedWrench& repeated) {
  const int64_t since_ns = static_cast<int64_t>(
      std::min<uint64_t>(elapsed_ns(frame.time_ns, repeated.time_ns), INT64_MAX / 2));
  const int64_t more_ns = std::clamp<int64_t>(repeated.hold_ns, 0, INT64_MAX / 2);
  frame.hold_ns = std::max(frame.hold_ns, since_ns + more_ns);
}

/// Whether there is time to ramp to zero and back between the two frames.
bool is_gap(const TimedWrench& frame, int64_t next_ns) {
  const int64_t hold_ns = std::max(frame.hold_ns, WrenchTimeline::kLongestHold_ns);
  return elapsed_ns(frame.time_ns, next_ns) >
         static_cast<uint64_t>(hold_ns) + 2 * static_cast<uint64_t>(WrenchTimeline::kRamp_ns);
}

/// Whether the frame `age`, not earlier than `motion_ns`, and the frame before it give no force: a
/// picture at rest was repeated, so the motion begins with the new picture, not with the last
/// repetition.
template <typename Segments>
bool rests_until(const Segments& segments, size_t age, int64_t motion_ns) {
  const auto is_zero = [&](size_t of) { return segments[of].frame.wrench.stacked().isZero(0); };
  return age + 1 < segments.size() && motion_ns <= segments[age].frame.time_ns && is_zero(age) &&
         is_zero(age + 1);
}

}  // namespace

size_t WrenchTimeline::size_after(int64_t time_ns) const noexcept {
  size_t after = 0;
  while (after < size() && segments_[after].frame.time_ns > time_ns) ++after;
  return after;
}

// A cubic Hermite curve from p0 with slope m0 to p1 with slope m1, in a time T, with s from 0 to 1:
//   p = (2s³ − 3s² + 1) p0 + (−2s³ + 3s²) p1 + (s³ − 2s² + s) T m0 + (s³ − s²) T m1
//     = p0 + s²(3 − 2s) (p1 − p0) + s(1 − s) T [(1 − s) m0 − s m1].
// p0 is the value of the previous segment at the same time. p0 is constant once that segment has
// ended. Until then m0 = 0, and the curve starts with the slope of the previous segment, because
// the weight of p1 and its derivative are zero at s = 0.
Wrench WrenchTimeline::value(size_t age, int64_t time_ns) const noexcept {
  const Segment& here = segments_[age];
  if (time_ns >= here.to_ns || age + 1 == size()) return here.frame.wrench;
  const Wrench before = here.from_rest ? Wrench() : value(age + 1, time_ns);
  const double duration_s = elapsed_s(here.from_ns, here.to_ns);
  const double s = elapsed_s(here.from_ns, time_ns) / duration_s;
  return interpolate(before, here.frame.wrench, s * s * (3 - 2 * s)) +
         s * (1 - s) * duration_s * ((1 - s) * here.from_slope - s * here.to_slope);
}

void WrenchTimeline::join_smoothly(Segment& next) noexcept {
  Segment& last = segments_[0];
  const bool has_begun = present_ns_ > last.from_ns;
  const bool is_plain =  // neither late nor overlapping the previous segment
      size() > 1 && last.to_ns == last.frame.motion_ns() &&
      (last.from_ns >= segments_[1].to_ns || rests_until(segments_, 1, last.to_ns));
  if (has_begun || !is_plain) return;
  const Wrench before = last.from_rest ? Wrench() : segments_[1].frame.wrench;
  last.to_slope = next.from_slope =
      slope_between(before, last.frame.wrench, next.frame.wrench,
                    elapsed_s(last.from_ns, last.to_ns), elapsed_s(last.to_ns, next.to_ns));
}

int64_t WrenchTimeline::approach_after(int64_t interval_ns) noexcept {
  const double fraction_ns = kApproachFraction * static_cast<double>(interval_ns);
  return std::max(std::min(kApproach_ns, interval_ns), static_cast<int64_t>(fraction_ns));
}

/// The earliest time at which the curve can reach `added`, a new frame that follows `before`.
int64_t WrenchTimeline::soonest(const TimedWrench& before,
                                const TimedWrench& added) const noexcept {
  if (present_ns_ == INT64_MIN) return INT64_MIN;
  constexpr int64_t kFar_ns = 1'000'000'000;
  const auto interval_ns =
      static_cast<int64_t>(std::min<uint64_t>(kFar_ns, elapsed_ns(before.time_ns, added.time_ns)));
  const int64_t now_ns = std::min(present_ns_, INT64_MAX - kFar_ns);
  const int64_t least_ns = now_ns + std::min(kApproach_ns, interval_ns);
  if (added.wrench.stacked().isZero(0) || has_expired(before, present_ns_)) return least_ns;
  const int64_t latest_ns = std::min(added.time_ns, INT64_MAX - kFar_ns) + kLatest_ns;
  return std::max(least_ns, std::min(now_ns + approach_after(interval_ns), latest_ns));
}

WrenchTimeline::Segment WrenchTimeline::segment_to(const TimedWrench& added) noexcept {
  Segment next;
  next.frame = added;
  const int64_t motion_ns = next.from_ns = next.to_ns = added.motion_ns();
  if (segments_.empty()) return next;

  const Segment& last = segments_[0];
  const int64_t soonest_ns = soonest(last.frame, added);
  const int64_t free_ns = segments_[rests_until(segments_, 0, motion_ns) ? 1 : 0].to_ns;
  const bool is_late = std::max(soonest_ns, free_ns) > motion_ns;
  if (is_late) {
    // The last frame has expired: the force is already ramping to zero, so there is nothing to
    // blend from.
    const bool at_rest = present_ns_ >= last.to_ns && has_expired(last.frame, present_ns_);
    if (at_rest) return next;
    next.from_ns = std::max(present_ns_, last.from_ns);
    next.to_ns = std::max(soonest_ns, motion_ns);
  } else if (motion_ns > last.frame.time_ns && is_gap(last.frame, motion_ns)) {
    next.from_rest = true;
    next.from_ns = std::max(present_ns_, motion_ns - kRamp_ns);
  } else {
    next.from_ns = std::max(present_ns_, free_ns);
    join_smoothly(next);
  }
  return next;
}

bool WrenchTimeline::push(const TimedWrench& added) noexcept {
  if (segments_.empty()) {
    segments_.add(segment_to(added));
    return true;
  }
  TimedWrench& last = segments_[0].frame;
  if (added.time_ns <= last.time_ns) return false;
  if (added.repeated) {
    if (!has_expired(last, present_ns_)) hold_until(last, added);
    return true;
  }
  TimedWrench next = added;
  const bool rests = rests_until(segments_, 0, added.motion_ns());
  const int64_t least_ns = rests ? segments_[1].to_ns : last.time_ns;
  const uint64_t most_ns = std::min<uint64_t>(elapsed_ns(least_ns, added.time_ns) - 1, INT64_MAX);
  next.before_ns = is_gap(last, added.time_ns)
                       ? 0
                       : std::clamp<int64_t>(added.before_ns, 0, static_cast<int64_t>(most_ns));
  segments_.add(segment_to(next));
  return true;
}

TimelineResult WrenchTimeline::at(int64_t time_ns) noexcept {
  TimelineResult result;
  if (segments_.empty()) return result;
  present_ns_ = time_ns;
  const size_t later = size_after(time_ns);
  if (later == size()) return result;

  const Segment& reached = segments_[later];
  result.frame_time_ns = reached.frame.time_ns;
  result.late_ns = reached.to_ns - reached.frame.motion_ns();
  size_t begun = 0;
  while (begun + 1 < size() && segments_[begun].from_ns > time_ns) ++begun;
  const auto is_met = [&](size_t age) {
    const Segment& segment = segments_[age];
    return segment.to_ns == time_ns && segment.frame.motion_ns() == time_ns;
  };
  const bool begins = segments_[begun].from_ns == time_ns && begun + 1 < size();
  if (is_met(begun) || (begins && is_met(begun + 1))) {
    result.wrench = segments_[is_met(begun) ? begun : begun + 1].frame.wrench;
    result.found = Found::kExact;
  } else if (time_ns < segments_[begun].to_ns) {
    result.wrench = value(begun, time_ns);
    result.found = Found::kInterpolated;
  } else {
    const TimedWrench& newest = segments_[std::min(begun, later)].frame;
    result.wrench = segments_[begun].frame.wrench;
    result.found = has_expired(newest, time_ns) ? Found::kExpired : Found::kHeld;
  }
  return result;
}

}  // namespace spidar
