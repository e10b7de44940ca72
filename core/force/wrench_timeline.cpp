#include "core/force/wrench_timeline.h"

namespace spidar {
namespace {

/// later − earlier ≥ 0, right for any two times: the difference may not fit into an int64_t.
uint64_t elapsed_ns(int64_t earlier_ns, int64_t later_ns) {
  return static_cast<uint64_t>(later_ns) - static_cast<uint64_t>(earlier_ns);
}

}  // namespace

bool WrenchTimeline::push(const TimedWrench& added) noexcept {
  if (count_ > 0 && added.time_ns <= entry(count_ - 1).time_ns) return false;
  if (count_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  entries_[(first_ + count_) % kCapacity] = added;
  ++count_;
  return true;
}

TimelineResult WrenchTimeline::at(int64_t time_ns) const noexcept {
  TimelineResult result;
  // From the newest back: the time asked for is near the end.
  size_t later = count_;
  while (later > 0 && entry(later - 1).time_ns > time_ns) --later;
  if (later == 0) return result;

  const TimedWrench& reached = entry(later - 1);
  const uint64_t since_ns = elapsed_ns(reached.time_ns, time_ns);
  result.frame_time_ns = reached.time_ns;
  result.wrench = reached.wrench;
  if (since_ns == 0) {
    result.found = Found::kExact;
  } else if (later < count_) {
    const TimedWrench& next = entry(later);
    const uint64_t interval_ns = elapsed_ns(reached.time_ns, next.time_ns);
    const double s = static_cast<double>(since_ns) / static_cast<double>(interval_ns);
    result.wrench = interpolate(reached.wrench, next.wrench, s);
    result.found = Found::kInterpolated;
  } else {
    const bool held = reached.hold_ns > 0 && since_ns <= static_cast<uint64_t>(reached.hold_ns);
    result.found = held ? Found::kHeld : Found::kExpired;
  }
  return result;
}

}  // namespace spidar
