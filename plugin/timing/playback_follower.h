// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Keeps the haptic loop's idea of the playback clock fresh.
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

/// What is behind an element and delays its frames: the latency that the sink received, `ts-offset`
/// of the sink (playbin: av-offset), offsets of the pads on the way, and elements on the way that
/// wait for the clock themselves (`clocksync`, `identity sync=true`). The sink shows a frame when
/// the last of those that wait has let it go.
///
/// Only the latency is sent by an event, and that one is not repeated for an element that is put
/// into a pipeline which plays already: so this looks at the way to the sink itself.
///
/// Not thread-safe: the owner holds one lock around it.
class PresentationDelay {
 public:
  PresentationDelay() = default;
  ~PresentationDelay() { reset(); }
  PresentationDelay(const PresentationDelay&) = delete;
  PresentationDelay& operator=(const PresentationDelay&) = delete;

  /// Looks downstream of `element`, through bins, for the first sink that waits for the clock, and
  /// keeps the way to it until reset(). Again whenever it may be another one.
  void follow(GstElement* element);
  void reset();

  /// From the LATENCY event; counts where no sink is found that waits.
  void set_latency(GstClockTime latency);

  /// As it is now, in ns; > 0: shown later.
  GstClockTimeDiff value_ns() const;

 private:
  std::vector<DownstreamStep> path_;
  std::vector<GstClockTimeDiff> latency_ns_;  ///< of live sources before each element of the path
  GstClockTimeDiff told_ns_ = 0;
};

/// Observes the pipeline's clock, and what delays the picture behind the element, a hundred times a
/// second while playing.
/// Frames are no good as the occasion: a queue behind the element holds them back, while a seek
/// changes the base time and an audio clock drifts. Thread-safe.
class PlaybackFollower {
 public:
  explicit PlaybackFollower(GstElement* element) : element_(element) {}
  ~PlaybackFollower() { end(); }

  /// A device begins to follow playback, which is not playing yet. `now` as in PlaybackSync.
  /// Without a thread the owner calls refresh().
  void begin(std::function<void(const PlaybackClock&)> publish, std::function<int64_t()> now,
             bool threaded);
  /// Publishes nothing any more.
  void end();

  void set_playing(bool playing);
  void set_latency(GstClockTime latency);
  void set_offset(GstClockTimeDiff offset_ns);
  /// By the sink, of running time: what follows is shown as much earlier.
  void set_skipped(int64_t skipped_ns);
  /// Something behind the element was linked anew.
  void look_for_sink();
  /// See PlaybackSync::expect_base_time().
  void expect_base_time();
  /// Looks at the pipeline's clock now; the thread does that by itself.
  void refresh();

 private:
  void run();
  void refresh_locked();

  GstElement* const element_;  ///< owns the owner of this
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
