/// Changes of the rate that do not seek.
#pragma once

#include <cmath>

#include <gst/gst.h>

namespace spidar {

/// Running time at the sink of what has a running time here. They differ from an instant change of
/// the rate on: segments stay as they are, and the sink shows frames closer together. The pipeline
/// tells where the change takes place (INSTANT_RATE_SYNC_TIME, GStreamer's design document
/// "seeking", section "instant rate changes").
class InstantRate {
 public:
  /// From here on `multiplier` times as fast: what is `upstream` here is shown at `running_time`.
  void change(double multiplier, GstClockTime running_time, GstClockTime upstream) {
    if (!(multiplier > 0)) return;
    multiplier_ = multiplier;
    shown_ns_ = static_cast<gint64>(running_time);
    here_ns_ = static_cast<gint64>(upstream);
  }
  void reset() { *this = {}; }

  double multiplier() const { return multiplier_; }

  gint64 at_sink(gint64 running_ns) const {
    if (multiplier_ == 1) return running_ns - here_ns_ + shown_ns_;
    const auto since_ns = static_cast<double>(running_ns - here_ns_);
    return shown_ns_ + std::llround(since_ns / multiplier_);
  }

 private:
  double multiplier_ = 1;
  gint64 shown_ns_ = 0;
  gint64 here_ns_ = 0;
};

}  // namespace spidar
