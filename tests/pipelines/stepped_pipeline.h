/// A whole pipeline on a GstTestClock, and the haptic loop of its spidarmotion ticked by hand: time
/// passes only when the test says so.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <gst/check/gsttestclock.h>
#include <gst/gst.h>

#include "plugin/motion_engine.h"
#include "tests/support/element_harness.h"

namespace spidar::test {

class SteppedPipeline {
 public:
  /// `launch` holds a spidarmotion named "motion" and a sink named "sink".
  explicit SteppedPipeline(const std::string& launch);
  ~SteppedPipeline();

  /// Changes state and lets the clock run as far as that needs.
  void play();
  void pause();
  /// Flushing, to this position.
  void seek(GstClockTime position);

  /// Waits until the pipeline waits for the clock, moves it to that time, and ticks the loop once.
  /// The record of that tick.
  TickRecord step();
  /// Moves the clock by `ns` without letting a frame through, and ticks the loop every millisecond.
  TickRecord idle(GstClockTime ns);

  GstClockTime now() const { return gst_clock_get_time(GST_CLOCK(clock_)); }
  /// When a frame of this running time is to be shown.
  GstClockTime presentation_time(GstClockTime running_time) const;

  /// Wrench of each frame since play() or seek(), by running time, as the element told it.
  const std::map<GstClockTime, Wrench>& wrenches();

  GstElement* element() const { return element_; }
  GstElement* pipeline() const { return pipeline_; }

 private:
  void wait_for_state(GstState state);
  TickRecord tick();

  GstTestClock* clock_;
  GstElement* pipeline_;
  GstElement* element_;
  GstElement* sink_;
  GstBus* bus_;
  MotionEngine* engine_;
  std::map<GstClockTime, Wrench> wrenches_;
};

}  // namespace spidar::test
