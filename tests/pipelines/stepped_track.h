// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A track that plays into a spidarsink on a GstTestClock; the haptic loop is ticked by hand.
#pragma once

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include <gst/check/gsttestclock.h>
#include <gst/gst.h>

#include "core/track/track_format.h"
#include "plugin/device/haptic_output.h"
#include "tests/support/element_harness.h"
#include "tests/support/tick_watch.h"

namespace spidar::test {

constexpr const char* kTrackCaps =
    "audio/x-raw,format=F32LE,layout=interleaved,rate=1000,channels=6,channel-mask=(bitmask)0x3f";

/// All buffers and EOS are pushed before the pipeline plays, so that the sink only waits for the
/// clock.
class SteppedTrack {
 public:
  explicit SteppedTrack(const std::string& properties = "", const std::string& caps = kTrackCaps);
  ~SteppedTrack();
  SteppedTrack(const SteppedTrack&) = delete;
  SteppedTrack& operator=(const SteppedTrack&) = delete;

  /// A buffer of bytes in the format of the caps.
  template <typename Sample>
  void push(const std::vector<Sample>& samples, GstClockTime pts, int rate_Hz = 1000) {
    push_bytes(samples.data(), samples.size() * sizeof(Sample), pts,
               gst_util_uint64_scale_int(samples.size(), GST_SECOND, rate_Hz));
  }
  void push_bytes(const void* bytes, size_t size, GstClockTime pts, GstClockTime duration);
  void end() { stream_.push_back(GST_MINI_OBJECT_CAST(gst_event_new_eos())); }

  /// Goes to PAUSED and sends the pushed buffers.
  void send();
  /// Sends the pushed buffers. Returns when the state has been reached.
  void set_state(GstState state);
  /// The next segment of the same stream; its running time begins at `base`.
  void continue_with(GstClockTime start, GstClockTime base);
  /// The first part of a flushing seek: nothing is pushed afterwards.
  void flush();
  /// A complete flushing seek: buffers are pushed again afterwards.
  void seek(double rate, GstClockTime start, GstClockTime stop = GST_CLOCK_TIME_NONE);
  /// Advances both clocks by a millisecond, lets the sink take what is due, and ticks the loop.
  TickRecord tick();
  TickRecord run(int ticks);
  /// Whether EOS was posted.
  bool ended();
  /// Those of `spidar-motion` since the last call.
  std::vector<MotionMessage> motions();
  /// Texts of warnings and errors since the last call.
  std::vector<std::string> warnings();

  GstElement* sink() const { return sink_; }
  guint64 stat(const char* name) const;

 private:
  void begin_segment(double rate, GstClockTime start, GstClockTime stop, GstClockTime base = 0);
  void let_through();

  GstTestClock* clock_;
  GstElement* pipeline_;
  GstElement* sink_;
  GstPad* source_;
  std::vector<GstMiniObject*> stream_;  // not yet sent
  std::thread sender_;
  GstBus* bus_;
  HapticOutput* output_;
  TickWatch watch_;
  bool ended_ = false;
  bool failed_ = false;
  bool flushing_ = false;
  std::vector<std::string> warnings_;
  std::vector<MotionMessage> motions_;
};

}  // namespace spidar::test
