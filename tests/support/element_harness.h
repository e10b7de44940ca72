// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A spidarmotion in a GstHarness, and its output.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gst/check/gstharness.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/filter/motion_state.h"
#include "tests/support/tick_watch.h"

namespace spidar::test {

/// gst_init() and registration of the element, once a process. No plugin of the system is needed.
void init_gstreamer();

/// The values of one `spidar-motion` message.
struct MotionMessage {
  GstClockTime running_time = 0, stream_time = 0, timestamp = 0, duration = 0;
  guint features = 0, tracked = 0;
  double velocity_x = 0, velocity_y = 0;
  Wrench wrench;
  bool repeated = false;
  std::string no_force, no_force_text;  ///< the latter may be missing
  std::string device_no_force;
  std::string track;
};
MotionMessage parse_motion_message(GstMessage* message);

/// Owns the harness and the element's bus. Unless properties say otherwise, the element works as in
/// the paper: motion=mean without a filter.
class ElementHarness {
 public:
  /// `properties` as in a launch line, e.g. "device=none alpha=0.02". `now` replaces
  /// CLOCK_MONOTONIC, and the haptic loop is ticked by the test.
  explicit ElementHarness(const std::string& properties = "device=none",
                          std::function<int64_t()> now = nullptr);
  ~ElementHarness();

  void set_caps(GstCaps* caps);  // takes them
  /// Pushes a frame; its flow return. `flags` are GstBufferFlags.
  GstFlowReturn push(GstBuffer* frame, GstClockTime pts, guint flags = 0);
  GstFlowReturn push_moved(double dx, double dy, GstClockTime pts, guint flags = 0);

  // Everything posted so far; of warnings and errors the message text.
  const std::vector<MotionMessage>& motions();
  const std::vector<std::string>& warnings();
  const std::vector<std::string>& errors();
  /// Of QoS messages.
  const std::vector<gint>& qualities();

  GstElement* element() const { return harness_->element; }
  GstHarness* harness() const { return harness_; }
  const GstVideoInfo& info() const { return info_; }
  filter::MotionState& state();
  /// Ticks the haptic loop of an element that waits for it, and checks the tick.
  TickRecord tick(int64_t now_ns) {
    return watch_.tick(state().feed.output.session()->loop(), now_ns);
  }

 private:
  void drain();

  GstHarness* harness_;
  GstBus* bus_;
  TickWatch watch_;
  GstVideoInfo info_{};
  std::vector<MotionMessage> motions_;
  std::vector<std::string> warnings_;
  std::vector<std::string> errors_;
  std::vector<gint> qualities_;
};

}  // namespace spidar::test
