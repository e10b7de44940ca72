// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/playback_follower.h"

#include <chrono>
#include <utility>

#include "spidar/realtime/thread_setup.h"

namespace spidar {

PlaybackFollower::PlaybackFollower(GstElement* element, Publish publish, PlaybackSync::Now now,
                                   void* now_user, bool threaded)
    : element_(element), publish_(std::move(publish)), sync_(now, now_user) {
  if (threaded) thread_ = start_thread("spidar-clock", [this] { run(); });
}

PlaybackFollower::~PlaybackFollower() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PlaybackFollower::set_playing(bool playing) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    playing_ = playing;
    sync_.set_playing(playing);
    sink_outdated_ = playing;
    if (!playing) delay_.forget();
    refresh_locked();
  }
  changed_.notify_all();
}

void PlaybackFollower::set_latency(GstClockTime latency) {
  const std::lock_guard<std::mutex> lock(mutex_);
  delay_.set_latency(latency);
  // The pipeline distributes the latency again when a sink is added.
  sink_outdated_ = true;
  refresh_locked();
}

void PlaybackFollower::look_for_sink() {
  // The search is left to the next refresh, because this thread is linking pads.
  const std::lock_guard<std::mutex> lock(mutex_);
  sink_outdated_ = true;
}

void PlaybackFollower::set_offset(GstClockTimeDiff offset_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  offset_ns_ = offset_ns;
  refresh_locked();
}

void PlaybackFollower::set_skipped(int64_t skipped_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sync_.set_skipped(skipped_ns);
  refresh_locked();
}

void PlaybackFollower::expect_base_time() {
  const std::lock_guard<std::mutex> lock(mutex_);
  sync_.expect_base_time(element_);
  refresh_locked();
}

void PlaybackFollower::refresh() {
  const std::lock_guard<std::mutex> lock(mutex_);
  refresh_locked();
}

void PlaybackFollower::refresh_locked() {
  if (playing_ && sink_outdated_) {
    sink_outdated_ = false;
    delay_.follow(element_);
  }
  sync_.set_offset(offset_ns_ + delay_.value_ns());
  publish_(sync_.observe(element_));
}

void PlaybackFollower::run() {
  constexpr std::chrono::milliseconds kPeriod(10);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    if (playing_) {
      refresh_locked();
      changed_.wait_for(lock, kPeriod);
    } else {
      changed_.wait(lock);
    }
  }
}

}  // namespace spidar
