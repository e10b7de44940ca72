// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
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

/// Calls gst_init() and registers the element, once a process. No plugin of the system is needed.
void init_gstreamer();

/// The values of one `spidar-motion` message.
struct MotionMessage {
  GstClockTime running_time = 0, stream_time = 0, timestamp = 0, duration = 0;
  guint features = 0, tracked = 0;
  double velocity_x = 0, velocity_y = 0;
  Wrench wrench;
  bool repeated = false;
  std::string no_force, no_force_text;  ///< the text may be missing
  std::string device_no_force;
  std::string track;
};
MotionMessage parse_motion_message(GstMessage* message);

/// A spidarmotion in a GstHarness, with its bus and its output. Unless properties say otherwise,
/// the element works as in the paper: motion=mean without a filter.
class ElementHarness {
 public:
  /// `properties` as in a launch line, e.g. "device=none alpha=0.02". `now` replaces
  /// CLOCK_MONOTONIC, and the test ticks the haptic loop.
  explicit ElementHarness(const std::string& properties = "device=none",
                          std::function<int64_t()> now = nullptr);
  ~ElementHarness();

  void set_caps(GstCaps* caps);  // takes ownership
  /// Pushes a frame and returns its flow. `flags` are GstBufferFlags.
  GstFlowReturn push(GstBuffer* frame, GstClockTime pts, guint flags = 0);
  /// The buffer that comes out for one that goes in without an error.
  GstBuffer* pass(GstBuffer* frame, GstClockTime pts, guint flags = 0);
  GstFlowReturn push_moved(double dx, double dy, GstClockTime pts, guint flags = 0);

  // Everything posted so far; of warnings and errors the message text.
  const std::vector<MotionMessage>& motions();
  const std::vector<std::string>& warnings();
  const std::vector<std::string>& errors();

  /// A field of the property `stats`, empty where it is none.
  std::string stats_field(const char* name) const;

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
};

}  // namespace spidar::test
