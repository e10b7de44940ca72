// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Keeps the haptic loop's idea of the playback clock fresh.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include <gst/gst.h>

#include "plugin/timing/playback_sync.h"
#include "plugin/timing/presentation_delay.h"
#include "spidar/loop/loop_time.h"

namespace spidar {

/// Observes the pipeline's clock, and what delays the picture behind the element, a hundred times a
/// second while playing.
/// Frames are no good as the occasion: a queue behind the element holds them back, while a seek
/// changes the base time and an audio clock drifts. Thread-safe.
class PlaybackFollower {
 public:
  using Publish = std::function<void(const PlaybackClock&)>;

  /// `now` as in PlaybackSync. Without a thread the owner calls refresh().
  PlaybackFollower(GstElement* element, Publish publish, PlaybackSync::Now now, void* now_user,
                   bool threaded);
  ~PlaybackFollower();

  void set_playing(bool playing);
  void set_latency(GstClockTime latency);
  void set_offset(GstClockTimeDiff offset_ns);
  void set_skipped(int64_t skipped_ns);
  /// Something behind the element was linked anew.
  void look_for_sink();
  /// See PlaybackSync::expect_base_time().
  void expect_base_time();
  void refresh();

 private:
  void run();
  void refresh_locked();

  GstElement* const element_;  // owns the owner of this
  const Publish publish_;
  std::mutex mutex_;
  std::condition_variable changed_;
  PlaybackSync sync_;
  PresentationDelay delay_;
  bool sink_outdated_ = false;
  GstClockTimeDiff offset_ns_ = 0;
  bool playing_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace spidar
