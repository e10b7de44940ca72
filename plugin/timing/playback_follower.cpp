// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/playback_follower.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <gst/base/gstbasesink.h>

#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

bool waits_for_clock(GstElement* element) {
  return GST_IS_BASE_SINK(element) && gst_base_sink_get_sync(GST_BASE_SINK(element));
}

bool has_property(GObject* object, const char* name, GType type) {
  const GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(object), name);
  return spec && spec->value_type == type && (spec->flags & G_PARAM_READABLE);
}

/// `ts-offset` of an element that is not a sink and waits for the clock.
std::optional<GstClockTimeDiff> offset_of_waiting(GstElement* element) {
  GObject* object = G_OBJECT(element);
  if (GST_IS_BASE_SINK(element) || !has_property(object, "sync", G_TYPE_BOOLEAN) ||
      !has_property(object, "ts-offset", G_TYPE_INT64)) {
    return std::nullopt;
  }
  gboolean sync = FALSE;
  gint64 offset_ns = 0;
  g_object_get(object, "sync", &sync, "ts-offset", &offset_ns, nullptr);
  if (!sync) return std::nullopt;
  return offset_ns;
}

/// The latency of the live sources, as a waiting element queries it; 0 without live sources.
GstClockTimeDiff latency_before(GstPad* sink_pad) {
  const Ref<GstQuery> query(gst_query_new_latency());
  gboolean live = FALSE;
  GstClockTime min = 0;
  if (gst_pad_peer_query(sink_pad, query.get())) {
    gst_query_parse_latency(query.get(), &live, &min, nullptr);
  }
  return live && GST_CLOCK_TIME_IS_VALID(min) ? static_cast<GstClockTimeDiff>(min) : 0;
}

}  // namespace

void PresentationDelay::follow(GstElement* element) {
  path_ = find_path_downstream(element, waits_for_clock);
  if (path_.empty()) {
    path_ = find_path_downstream(
        element, [](GstElement* candidate) { return offset_of_waiting(candidate).has_value(); });
  }
  latency_ns_.clear();
  for (const DownstreamStep& step : path_) {
    const bool waits = step.element && offset_of_waiting(step.element.get());
    latency_ns_.push_back(waits ? latency_before(step.pad.get()) : 0);
  }
}

void PresentationDelay::reset() {
  path_.clear();
  latency_ns_.clear();
}

void PresentationDelay::set_latency(GstClockTime latency) {
  told_ns_ = GST_CLOCK_TIME_IS_VALID(latency) ? static_cast<GstClockTimeDiff>(latency) : 0;
}

GstClockTimeDiff PresentationDelay::value_ns() const {
  GstClockTimeDiff pads_ns = 0;
  std::optional<GstClockTimeDiff> shown_ns;
  const auto wait_until = [&shown_ns](GstClockTimeDiff ns) {
    shown_ns = shown_ns ? std::max(*shown_ns, ns) : ns;
  };
  for (size_t i = 0; i < path_.size(); ++i) {
    const DownstreamStep& step = path_[i];
    pads_ns += gst_pad_get_offset(step.pad.get());
    if (!step.element) continue;
    if (waits_for_clock(step.element.get())) {
      GstBaseSink* sink = GST_BASE_SINK(step.element.get());
      wait_until(pads_ns + static_cast<GstClockTimeDiff>(gst_base_sink_get_latency(sink)) +
                 gst_base_sink_get_ts_offset(sink));
    } else if (const auto offset_ns = offset_of_waiting(step.element.get())) {
      wait_until(pads_ns + latency_ns_[i] + *offset_ns);
    }
  }
  return shown_ns.value_or(pads_ns + told_ns_);
}

void PlaybackFollower::begin(std::function<void(const PlaybackClock&)> publish,
                             std::function<int64_t()> now, bool threaded) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (threaded) thread_ = start_thread("spidar-clock", [this] { run(); });
  publish_ = std::move(publish);
  sync_ = PlaybackSync(std::move(now));
  refresh_locked();
}

void PlaybackFollower::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    publish_ = nullptr;
    playing_ = false;
    delay_.reset();
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
    if (!playing) delay_.reset();
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

void PlaybackFollower::find_sink() {
  // The next refresh searches, because this thread is linking pads.
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
  if (!publish_) return;
  sync_.expect_base_time(element_);
  refresh_locked();
}

void PlaybackFollower::refresh() {
  const std::lock_guard<std::mutex> lock(mutex_);
  refresh_locked();
}

void PlaybackFollower::refresh_locked() {
  if (!publish_) return;
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
  while (publish_) {
    if (playing_) {
      refresh_locked();
      changed_.wait_for(lock, kPeriod);
    } else {
      changed_.wait(lock);
    }
  }
}

}  // namespace spidar
