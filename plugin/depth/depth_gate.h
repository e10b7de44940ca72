// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where the thread of the video and the thread of the depth meet.
#pragma once

#include <gst/gst.h>

#include "plugin/depth/depth_match.h"

namespace spidar {

/// Depth images wait here for the video, one at a time, and the video waits for them: as long as it
/// takes, or, where a live pipeline has a deadline, until then. Every function may be called from
/// any thread.
class DepthGate {
 public:
  /// `owner` holds the gate, and lives for as long as a timer may ring.
  explicit DepthGate(GstObject* owner);
  ~DepthGate();
  DepthGate(const DepthGate&) = delete;
  DepthGate& operator=(const DepthGate&) = delete;

  /// Nothing has come, nobody has to wait for long.
  void open();
  /// Releases whoever waits and lets nobody wait again, until open().
  void close();

  // The thread of the depth.
  void set_linked(bool linked);
  /// Waits for room. OK, FLUSHING, or EOS when the video has ended.
  GstFlowReturn add(DepthImage image);
  void reach(gint64 running_ns);
  void finish_depth();
  void begin_depth();  ///< a stream or segment, after the end of another
  void flush_depth(bool begin);

  // The thread of the video.
  struct Found {
    GstFlowReturn flow = GST_FLOW_OK;  ///< or FLUSHING
    DepthImage image;                  ///< without a buffer when nothing belongs to the frame
  };
  /// `clock` may be null: then it waits as long as it takes. `deadline_ns` is a time of the clock.
  Found find(const ShownTime& frame, guint64 max_age_ns, GstClock* clock, GstClockTime deadline_ns);
  void finish_video();
  void begin_video();
  void flush_video(bool begin);

  /// A seek is under way that flushes both: what has come belongs to the time before.
  void begin_seek();
  void end_seek();

 private:
  static gboolean wake(GstClock*, GstClockTime, GstClockID, gpointer alarm);

  struct Alarm {
    DepthGate* gate;
    GstObject* owner;
  };

  GstObject* owner_;
  GMutex mutex_;
  GCond changed_;
  // Below: the mutex.
  DepthMatch match_;
  bool closed_ = true;
  bool linked_ = false;
  bool seeking_ = false;
  bool depth_flushing_ = false;
  bool video_flushing_ = false;
  bool video_ended_ = false;
};

}  // namespace spidar
