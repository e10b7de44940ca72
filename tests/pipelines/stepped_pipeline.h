// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A whole pipeline on a GstTestClock; the haptic loop of its spidarmotion is ticked by hand. Time
/// passes only when the test advances it.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <gst/check/gsttestclock.h>
#include <gst/gst.h>

#include "plugin/filter/motion_state.h"
#include "tests/support/element_harness.h"
#include "tests/support/message_inbox.h"

namespace spidar::test {

class SteppedPipeline {
 public:
  /// `launch` must contain a spidarmotion named "motion" and a sink named "sink".
  explicit SteppedPipeline(const std::string& launch);
  ~SteppedPipeline();

  /// Returns when the state has been reached.
  void set_state(GstState state);
  /// Goes to PLAYING without waiting for the sink, which has nothing to show before the first
  /// step().
  void play_live();
  /// Flushing seek to this position of the stream.
  void seek(GstClockTime position);
  /// Plays from `start` to `stop` of the stream at this rate. Returns when the state has been
  /// reached again.
  void seek(double rate, int flags, GstClockTime start, GstClockTime stop);
  /// Makes the sink step over this number of frames (GST_EVENT_STEP). Returns when the next frame
  /// has arrived.
  void step_frames(guint64 count);
  /// Replaces the pipeline's clock by one that shows this time. The pipeline goes through PAUSED,
  /// as after CLOCK_LOST.
  void replace_clock(GstClockTime start);
  /// Timestamps for the element, by number of the frame; set them before playing.
  void retime(std::function<GstClockTime(int frame, GstClockTime pts)> pts);

  /// Waits until `waiters` elements wait for the clock; returns the earliest of their times.
  GstClockTime await(guint waiters = 1);
  /// Waits like await(), moves the clock to that time, ticks the loop once, and lets that element
  /// continue. Returns the record of the tick, which comes early_ns() before that time: where the
  /// sink shows a frame with a motion, halfway since the frame before, when that motion is felt.
  /// It is 0 across a gap, and where the tick before is too near for the force to be there.
  /// `beside` is called with the tick.
  TickRecord step(guint waiters = 1, const std::function<void()>& beside = {});
  int64_t early_ns() const { return early_ns_; }
  /// Moves the clock without letting anything pass, and ticks the loop every millisecond. Returns
  /// the record of the last tick.
  TickRecord idle(GstClockTime duration);
  /// Stops the pipeline's clock for this time, and ticks the loop every millisecond.
  TickRecord stand_still(GstClockTime duration);

  GstClockTime now() const { return gst_clock_get_time(GST_CLOCK(clock_)); }
  /// Running time of the frame that should be shown now.
  GstClockTime running_time() const;
  /// Running time of the frame that the sink had at the last step(), as the sink received it.
  GstClockTime shown() const { return shown_; }

  /// Waits for a message of this type since the last call.
  void await_message(GstMessageType type);
  /// Whether there was a message of this type since the last await_message() for it.
  bool has_posted(GstMessageType type);
  /// Waits until the element has received this number of frames.
  void await_analysed(size_t frames);
  /// Waits until the stream has ended for the element, which is before it ends for the sink.
  void await_end_of_stream();
  /// Wrench of each frame since the start or the last seek, by running time, from the element's
  /// messages.
  const std::map<GstClockTime, Wrench>& wrenches();
  /// Drops entries of wrenches() before this running time.
  void forget_before(GstClockTime running_time);

  /// The loop of the element, which step() and idle() tick.
  HapticLoop& loop();
  GstElement* element() const { return element_; }
  GstElement* sink() const { return sink_; }
  GstElement* pipeline() const { return pipeline_; }

 private:
  void wait_for_state();
  TickRecord tick();
  int64_t half_frame_ns(GstClockTime next);
  void take(GstMessage* message);

  /// Time for the haptic loop; continues when the pipeline's clock is replaced.
  int64_t monotonic_ns() const;

  GstTestClock* clock_;
  int64_t monotonic_less_clock_ns_ = 0;
  GstElement* pipeline_;
  GstElement* element_;
  GstElement* sink_;
  std::unique_ptr<MessageInbox> inbox_;
  filter::MotionState* state_;
  TickWatch watch_;
  std::map<GstClockTime, Wrench> wrenches_;
  unsigned messages_ = 0;                                 // types seen
  std::atomic<GstClockTime> taken_{GST_CLOCK_TIME_NONE};  // by the sink
  GstClockTime shown_ = GST_CLOCK_TIME_NONE;
  int64_t early_ns_ = 0;
  GstClockTime ticked_ = 0;  // at which the loop was ticked last
  std::function<GstClockTime(int, GstClockTime)> pts_;
  int frames_ = 0;  // streaming thread
};

}  // namespace spidar::test
