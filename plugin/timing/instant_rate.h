// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>

#include <gst/gst.h>

namespace spidar {

/// Running times beyond 73 years are invalid, so that sums of a few valid ones fit an int64_t.
constexpr gint64 kLatest_ns = gint64{1} << 61;

inline bool is_time(GstClockTime running_time) {
  return running_time <= static_cast<GstClockTime>(kLatest_ns);
}

/// Converts running times of the element to those of the sink. They differ after a change of the
/// rate without a seek: segments stay as they are, and the sink shows frames closer together. The
/// pipeline announces where the change takes place (INSTANT_RATE_SYNC_TIME, GStreamer's design
/// document "seeking", section "instant rate changes").
class InstantRate {
 public:
  /// From here on, the sink shows frames `multiplier` times as fast: the one at `upstream` here is
  /// shown at `running_time`. Invalid arguments are ignored.
  void change(double multiplier, GstClockTime running_time, GstClockTime upstream) {
    if (!(multiplier > 0) || !is_time(running_time) || !is_time(upstream)) return;
    multiplier_ = multiplier;
    shown_ns_ = static_cast<gint64>(running_time);
    here_ns_ = static_cast<gint64>(upstream);
  }
  void reset() { *this = {}; }

  double multiplier() const { return multiplier_; }

  /// The result lies within ±kLatest_ns, as `running_ns` must.
  gint64 at_sink(gint64 running_ns) const {
    const gint64 since_ns = running_ns - here_ns_;
    if (multiplier_ == 1) return std::clamp(shown_ns_ + since_ns, -kLatest_ns, kLatest_ns);
    constexpr auto kLatest = static_cast<double>(kLatest_ns);
    const double later_ns = static_cast<double>(since_ns) / multiplier_;
    const gint64 shown_ns = shown_ns_ + std::llround(std::clamp(later_ns, -kLatest, kLatest));
    return std::clamp(shown_ns, -kLatest_ns, kLatest_ns);
  }

 private:
  double multiplier_ = 1;
  gint64 shown_ns_ = 0;
  gint64 here_ns_ = 0;
};

}  // namespace spidar
