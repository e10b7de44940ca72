// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/haptic_feed.h"

#include "plugin/frame/touch_view.h"

namespace spidar::filter {

HapticFeed::HapticFeed(GstElement* element)
    : output(element, [this] {
        schedule.forward_waiting();
        track_samples.forward_waiting();
      }) {}

std::string HapticFeed::open(const MotionProperties& properties) {
  if (properties.device == "none") {
    if (properties.haptic_trace.empty()) return {};
    return "haptic-trace=" + properties.haptic_trace +
           " is not written: it is of a device, and device=none opens none. trace= writes what "
           "each frame asks for";
  }
  const std::string trace_error =
      output.open(properties.device, properties.profile, properties.analyzer.controller.max_force_N,
                  properties.haptic_trace);
  HapticLoop* const loop = &output.session()->loop();
  schedule.connect(loop);
  track_samples.connect(loop);
  reliefs.connect(loop, output.profile(), GripPointer(output.profile().geometry).half_size_m());
  no_force.set_can_touch(output.session()->grip().abilities().can_touch());
  return trace_error;
}

void HapticFeed::close() {
  schedule.connect(nullptr);
  track_samples.connect(nullptr);
  output.close();
  reliefs.disconnect();
}

void HapticFeed::set_muted(bool muted) {
  schedule.set_muted(muted);
  track_samples.set_muted(muted);
  no_force.set_muted(muted);
  reliefs.set_muted(muted);
}

void HapticFeed::clear() {
  schedule.clear();
  track_samples.clear();
  reliefs.clear();
}

void HapticFeed::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(skip_mutex_);
  schedule.skip(duration);
  output.follower().set_skipped(schedule.skipped_ns());
}

void HapticFeed::change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream) {
  // Drop all samples of a track; the next frame adds them again at the new rate. Do this first:
  // samples that are added after the rate of the schedule has changed must stay.
  track_samples.clear();
  schedule.change_rate(multiplier, running_time, upstream);
}

void HapticFeed::reset() {
  {
    const std::lock_guard<std::mutex> lock(skip_mutex_);
    schedule.reset();
    output.follower().set_skipped(0);
  }
  no_force.reset();
}

}  // namespace spidar::filter
