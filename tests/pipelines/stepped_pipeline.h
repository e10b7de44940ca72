// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A whole pipeline on a GstTestClock, and the haptic loop of its spidarmotion ticked by hand: time
/// passes only when the test says so.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <gst/check/gsttestclock.h>
#include <gst/gst.h>

#include "plugin/engine/motion_engine.h"
#include "tests/support/element_harness.h"
#include "tests/support/message_inbox.h"

namespace spidar::test {

class SteppedPipeline {
 public:
  /// `launch` holds a spidarmotion named "motion" and a sink named "sink".
  explicit SteppedPipeline(const std::string& launch);
  ~SteppedPipeline();

  /// Returns when the state is reached.
  void set_state(GstState state);
  /// To PLAYING, without waiting for the sink: it has nothing to show before the first step().
  void play_live();
  /// Flushing, to this position of the stream.
  void seek(GstClockTime position);
  /// From `start` to `stop` of the stream at this rate. Returns when the state is reached again.
  void seek(double rate, int flags, GstClockTime start, GstClockTime stop);
  /// The sink steps over so many frames (GST_EVENT_STEP). Returns when the next one is there.
  void step_frames(guint64 count);
  /// A clock that shows this time takes the place of the pipeline's, which goes through PAUSED as
  /// an application does on CLOCK_LOST.
  void replace_clock(GstClockTime start);
  /// What the element is given for a timestamp, by number of the frame; before playing.
  void retime(std::function<GstClockTime(int frame, GstClockTime pts)> pts);

  /// Waits until `waiters` elements wait for the clock; the earliest of their times.
  GstClockTime await(guint waiters = 1);
  /// Waits like await(), moves the clock to that time, ticks
  /// the loop once, and lets that element go on. The record of the tick.
  TickRecord step(guint waiters = 1);
  /// Moves the clock without letting anything through, and ticks the loop every millisecond. The
  /// record of the last tick.
  TickRecord idle(GstClockTime duration);
  /// The pipeline's clock stands still for so long, while the loop is ticked every millisecond.
  TickRecord stand_still(GstClockTime duration);

  GstClockTime now() const { return gst_clock_get_time(GST_CLOCK(clock_)); }
  /// Of the frame that is to be shown now.
  GstClockTime running_time() const;
  /// Of the frame that the sink had at the last step(), as it came to the sink.
  GstClockTime shown() const { return shown_; }

  /// Waits for a message of this type since the last call.
  void await_message(GstMessageType type);
  /// Waits until the element has seen so many frames.
  void await_analysed(size_t frames);
  /// Wrench of each frame since the start or the last seek, by running time, as the element told
  /// it.
  const std::map<GstClockTime, Wrench>& wrenches();
  /// Frees what wrenches() has from before this running time.
  void forget_before(GstClockTime running_time);

  GstElement* element() const { return element_; }
  GstElement* sink() const { return sink_; }
  GstElement* pipeline() const { return pipeline_; }

 private:
  void wait_for_state();
  TickRecord tick();
  void take(GstMessage* message);

  /// For the haptic loop: goes on when the pipeline's clock is replaced.
  static int64_t monotonic_ns(void* self);

  GstTestClock* clock_;
  int64_t monotonic_less_clock_ns_ = 0;
  GstElement* pipeline_;
  GstElement* element_;
  GstElement* sink_;
  std::unique_ptr<MessageInbox> inbox_;
  MotionEngine* engine_;
  TickWatch watch_;
  std::map<GstClockTime, Wrench> wrenches_;
  unsigned messages_ = 0;                                 // types seen
  std::atomic<GstClockTime> taken_{GST_CLOCK_TIME_NONE};  // by the sink
  GstClockTime shown_ = GST_CLOCK_TIME_NONE;
  std::function<GstClockTime(int, GstClockTime)> pts_;
  int frames_ = 0;  // streaming thread
};

}  // namespace spidar::test
