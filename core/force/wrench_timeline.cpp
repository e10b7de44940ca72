#include "core/force/wrench_timeline.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

using Vector3d = Eigen::Vector3d;

/// later − earlier ≥ 0, right for any two times: the difference may not fit into an int64_t.
uint64_t elapsed_ns(int64_t earlier_ns, int64_t later_ns) {
  return static_cast<uint64_t>(later_ns) - static_cast<uint64_t>(earlier_ns);
}

double elapsed_s(int64_t earlier_ns, int64_t later_ns) {
  return 1e-9 * static_cast<double>(elapsed_ns(earlier_ns, later_ns));
}

/// Slopes of the straight lines before and after a frame, and how long each of them is.
struct Chord {
  Vector3d slope;
  double duration_s;
};

/// Steffen's slope at the point where the lines meet, zero where that is not a number.
Vector3d slope_between(const Chord& before, const Chord& after) {
  Vector3d slope;
  for (int i = 0; i < 3; ++i) {
    const double a = before.slope[i];
    const double b = after.slope[i];
    const double parabola =
        (a * after.duration_s + b * before.duration_s) / (before.duration_s + after.duration_s);
    const double steepest = 2 * std::min({std::fabs(a), std::fabs(b), 0.5 * std::fabs(parabola)});
    const bool same_way = a * b > 0 && std::isfinite(steepest);
    slope[i] = same_way ? std::copysign(steepest, a) : 0;
  }
  return slope;
}

/// Chords of `duration_s` from `a` to `b`.
Chord force_chord(const Wrench& a, const Wrench& b, double duration_s) {
  return {(b.force_N - a.force_N) / duration_s, duration_s};
}
Chord torque_chord(const Wrench& a, const Wrench& b, double duration_s) {
  return {(b.torque_Nm - a.torque_Nm) / duration_s, duration_s};
}

}  // namespace

bool WrenchTimeline::push(const TimedWrench& added) noexcept {
  Knot next{added, added.time_ns, {}};
  if (count_ > 0) {
    Knot& last = knot(count_ - 1);
    const TimedWrench& middle = last.timed;
    if (added.time_ns <= middle.time_ns) return false;
    next.from_ns = std::clamp(present_ns_, middle.time_ns, added.time_ns);
    if (count_ > 1 && present_ns_ <= last.from_ns) {
      const TimedWrench& first = knot(count_ - 2).timed;
      const double before_s = elapsed_s(first.time_ns, middle.time_ns);
      const double after_s = elapsed_s(middle.time_ns, added.time_ns);
      last.slope.force_N = slope_between(force_chord(first.wrench, middle.wrench, before_s),
                                         force_chord(middle.wrench, added.wrench, after_s));
      last.slope.torque_Nm = slope_between(torque_chord(first.wrench, middle.wrench, before_s),
                                           torque_chord(middle.wrench, added.wrench, after_s));
    }
  }
  if (count_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  knot(count_) = next;
  ++count_;
  return true;
}

TimelineResult WrenchTimeline::at(int64_t time_ns) noexcept {
  TimelineResult result;
  if (count_ == 0) return result;
  present_ns_ = time_ns;
  // From the newest back: the time asked for is near the end.
  size_t later = count_;
  while (later > 0 && knot(later - 1).timed.time_ns > time_ns) --later;
  if (later == 0) return result;

  const Knot& reached = knot(later - 1);
  const uint64_t since_ns = elapsed_ns(reached.timed.time_ns, time_ns);
  result.frame_time_ns = reached.timed.time_ns;
  result.wrench = reached.timed.wrench;
  if (since_ns == 0) {
    result.found = Found::kExact;
  } else if (later < count_ && knot(later).from_ns <= time_ns) {
    const Knot& next = knot(later);
    const double duration_s = elapsed_s(next.from_ns, next.timed.time_ns);
    const double s = elapsed_s(next.from_ns, time_ns) / duration_s;
    // Held until the curve begins, it begins level; so does reached.slope then, see push().
    result.wrench = interpolate(reached.timed.wrench, next.timed.wrench, s * s * (3 - 2 * s)) +
                    s * (1 - s) * duration_s * ((1 - s) * reached.slope - s * next.slope);
    result.found = Found::kInterpolated;
  } else {
    const int64_t hold_ns = reached.timed.hold_ns;
    const bool held = hold_ns > 0 && since_ns <= static_cast<uint64_t>(hold_ns);
    result.found = held ? Found::kHeld : Found::kExpired;
  }
  return result;
}

}  // namespace spidar
