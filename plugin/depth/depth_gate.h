// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Synchronizes the video thread and the depth thread.
#pragma once

#include <gst/gst.h>

#include "plugin/depth/depth_match.h"

namespace spidar {

/// Depth images wait here for the video, one at a time, and video frames wait for their depth
/// image: without limit, or until the deadline in a live pipeline. All functions are thread-safe.
class DepthGate {
 public:
  /// `owner` contains the gate, and must outlive every pending clock callback.
  explicit DepthGate(GstObject* owner);
  ~DepthGate();
  DepthGate(const DepthGate&) = delete;
  DepthGate& operator=(const DepthGate&) = delete;

  /// Resets the gate to an empty state and allows waiting.
  void open();
  /// Wakes all waiting threads and prevents further waiting until open().
  void close();

  // Depth thread.
  void set_linked(bool linked);
  /// Waits for room. Returns OK, FLUSHING, or EOS when the video has ended.
  GstFlowReturn add(DepthImage image);
  void reach(gint64 running_ns);
  void finish_depth();
  void begin_depth();  ///< a new stream or segment begins after the end of another
  void flush_depth(bool begin);

  // Video thread.
  struct Found {
    GstFlowReturn flow = GST_FLOW_OK;  ///< or FLUSHING
    DepthImage image;                  ///< without a buffer if no image belongs to the frame
  };
  /// Waits for the depth image of a frame until `deadline_ns`, a time of `clock`; without limit if
  /// `clock` is null.
  Found find(const ShownTime& frame, guint64 max_age_ns, GstClock* clock, GstClockTime deadline_ns);
  void finish_video();
  void begin_video();
  void flush_video(bool begin);

  /// Begins a seek that flushes both streams. Images received so far are from before the seek.
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
  // Guarded by the mutex.
  DepthMatch match_;
  bool closed_ = true;
  bool linked_ = false;
  bool seeking_ = false;
  bool depth_flushing_ = false;
  bool video_flushing_ = false;
  bool video_ended_ = false;
};

}  // namespace spidar
