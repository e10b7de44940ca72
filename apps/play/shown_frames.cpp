// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#define GST_USE_UNSTABLE_API  // tracer hooks are the only place after a sink's drawing

#include "apps/play/shown_frames.h"

#include <ctime>
#include <utility>

#include <gst/base/gstbasesink.h>
#include <gst/gsttracer.h>

namespace {

struct Watch {
  GstElement* sink = nullptr;
  GstPad* sink_pad = nullptr;
  bool has_stats = false;
  std::function<void(int64_t, int64_t)> on_shown;
  // The push in progress; only one thread pushes into a sink.
  int64_t running_ns = -1;
  uint64_t rendered = 0;
};

Watch watch;

// A hook must belong to a tracer; this one has no other purpose.
struct HookOwner {
  GstTracer parent;
};
struct HookOwnerClass {
  GstTracerClass parent_class;
};
G_DEFINE_TYPE(HookOwner, hook_owner, GST_TYPE_TRACER)
void hook_owner_class_init(HookOwnerClass*) {}
void hook_owner_init(HookOwner*) {}

bool leads_to_sink(GstPad* pad) {
  GstPad* const peer = gst_pad_get_peer(pad);
  if (peer == nullptr) return false;
  gst_object_unref(peer);
  return peer == watch.sink_pad;
}

/// 0 for a sink without statistics.
uint64_t frames_rendered() {
  if (!watch.has_stats) return 0;
  GstStructure* stats = nullptr;
  g_object_get(watch.sink, "stats", &stats, nullptr);
  guint64 rendered = 0;
  gst_structure_get_uint64(stats, "rendered", &rendered);
  gst_structure_free(stats);
  return rendered;
}

int64_t running_time_ns(GstBuffer* buffer) {
  GstEvent* const event = gst_pad_get_sticky_event(watch.sink_pad, GST_EVENT_SEGMENT, 0);
  if (event == nullptr) return -1;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event, &segment);
  const uint64_t running_ns =
      gst_segment_to_running_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  gst_event_unref(event);
  return running_ns == GST_CLOCK_TIME_NONE ? -1 : static_cast<int64_t>(running_ns);
}

void before_push(GObject*, GstClockTime, GstPad* pad, GstBuffer* buffer) {
  if (!leads_to_sink(pad)) return;
  watch.running_ns = running_time_ns(buffer);
  watch.rendered = frames_rendered();
}

void after_push(GObject*, GstClockTime, GstPad* pad, GstFlowReturn) {
  if (!leads_to_sink(pad)) return;
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  const bool dropped = watch.has_stats && frames_rendered() == watch.rendered;
  if (watch.running_ns < 0 || dropped) return;
  watch.on_shown(watch.running_ns, now.tv_sec * INT64_C(1'000'000'000) + now.tv_nsec);
}

}  // namespace

void watch_shown_frames(GstElement* sink, std::function<void(int64_t, int64_t)> on_shown) {
  watch.sink = GST_ELEMENT(gst_object_ref(sink));
  watch.sink_pad = gst_element_get_static_pad(sink, "sink");
  watch.has_stats = GST_IS_BASE_SINK(sink);
  watch.on_shown = std::move(on_shown);
  auto* const owner = GST_TRACER(g_object_new(hook_owner_get_type(), nullptr));
  gst_tracing_register_hook(owner, "pad-push-pre", G_CALLBACK(before_push));
  gst_tracing_register_hook(owner, "pad-push-post", G_CALLBACK(after_push));
  gst_object_unref(owner);  // the hooks hold it
}
