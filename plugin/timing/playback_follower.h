// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <gst/gst.h>

#include "plugin/gobject/downstream.h"
#include "plugin/timing/playback_sync.h"
#include "spidar/loop/loop_time.h"

namespace spidar {

/// The delay of an element's frames on the way to the screen. The delay consists of the latency
/// that the sink received, the `ts-offset` of the sink (playbin: av-offset) and the offsets of the
/// pads on the way. Elements on the way may also wait for the clock themselves (`clocksync`,
/// `identity sync=true`); the sink shows a frame when the last of these has passed it on.
///
/// Only the latency is sent in an event, and the event is not repeated for an element that joins a
/// pipeline while it plays. This class therefore examines the path to the sink itself.
///
/// Not thread-safe: the owner holds one lock around it.
class PresentationDelay {
 public:
  PresentationDelay() = default;
  ~PresentationDelay() { reset(); }
  PresentationDelay(const PresentationDelay&) = delete;
  PresentationDelay& operator=(const PresentationDelay&) = delete;

  /// Searches downstream of `element`, through bins, for the first sink that waits for the clock,
  /// and keeps the path to that sink until reset(). Call this again when the sink may have changed.
  void follow(GstElement* element);
  void reset();

  /// Sets the latency from the LATENCY event, which is used if no waiting element is found.
  void set_latency(GstClockTime latency);

  /// The present delay in ns; > 0: frames are shown later.
  GstClockTimeDiff value_ns() const;

 private:
  std::vector<DownstreamStep> path_;
  std::vector<GstClockTimeDiff> latency_ns_;  ///< of live sources before each element of the path
  GstClockTimeDiff told_ns_ = 0;
};

/// Publishes to the haptic loop the pipeline's clock, and what delays the picture behind the
/// element, a hundred times a second while playing. It does not wait for frames, because a queue
/// behind the element may hold them back while a seek changes the base time and an audio clock
/// drifts. Thread-safe.
class PlaybackFollower {
 public:
  explicit PlaybackFollower(GstElement* element) : element_(element) {}
  ~PlaybackFollower() { end(); }

  /// Begins to publish for a device, before playback starts. `now` is that of PlaybackSync. Unless
  /// `threaded`, the owner calls refresh().
  void begin(std::function<void(const PlaybackClock&)> publish, std::function<int64_t()> now,
             bool threaded);
  void end();

  void set_playing(bool playing);
  void set_latency(GstClockTime latency);
  void set_offset(GstClockTimeDiff offset_ns);
  /// Sets the running time that the sink has stepped over: it shows later frames that much earlier.
  void set_skipped(int64_t skipped_ns);
  /// Call this when links behind the element have changed.
  void find_sink();
  void expect_base_time();
  /// Reads the pipeline's clock now, as the thread does regularly.
  void refresh();

 private:
  void run();
  void refresh_locked();

  GstElement* const element_;  ///< owns the owner of this object
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void(const PlaybackClock&)> publish_;  ///< null: there is no device
  PlaybackSync sync_{nullptr};
  PresentationDelay delay_;
  bool sink_outdated_ = false;
  GstClockTimeDiff offset_ns_ = 0;
  bool playing_ = false;
  std::thread thread_;
};

}  // namespace spidar
