// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/screen.h"

#include <utility>

#include <gst/video/gstvideosink.h>

#include "spidar/realtime/monotonic.h"

namespace spidar::bench {
namespace {

struct Screen {
  GstVideoSink parent;
  OnShown* on_shown;
};
struct ScreenClass {
  GstVideoSinkClass parent_class;
};

GstStaticPadTemplate screen_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS("video/x-raw, format=(string)I420"));

G_DEFINE_TYPE(Screen, screen, GST_TYPE_VIDEO_SINK)

Screen* screen_of(gpointer object) {
  return G_TYPE_CHECK_INSTANCE_CAST(object, screen_get_type(), Screen);
}

GstFlowReturn screen_render(GstBaseSink* sink, GstBuffer* buffer) {
  const int64_t now_ns = monotonic_now_ns();
  const GstClockTime running_time =
      gst_segment_to_running_time(&sink->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  if (!GST_CLOCK_TIME_IS_VALID(running_time)) return GST_FLOW_OK;
  GstElement* const element = GST_ELEMENT(sink);
  GstClock* const clock = gst_element_get_clock(element);
  const GstClockTimeDiff late_ns =
      GST_CLOCK_DIFF(
          gst_element_get_base_time(element) + running_time + gst_base_sink_get_latency(sink),
          gst_clock_get_time(clock)) -
      gst_base_sink_get_ts_offset(sink);
  gst_object_unref(clock);
  (*screen_of(sink)->on_shown)({static_cast<int64_t>(running_time), now_ns, now_ns - late_ns});
  return GST_FLOW_OK;
}

void screen_finalize(GObject* object) {
  delete screen_of(object)->on_shown;
  G_OBJECT_CLASS(screen_parent_class)->finalize(object);
}

void screen_class_init(ScreenClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = screen_finalize;
  GST_BASE_SINK_CLASS(klass)->render = screen_render;
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &screen_template);
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "Screen", "Sink/Video",
                                        "Says when it shows a frame", "gst-spidar");
}

void screen_init(Screen*) {}

}  // namespace

GstElement* make_screen(OnShown on_shown) {
  auto* const screen = static_cast<Screen*>(g_object_new(screen_get_type(), nullptr));
  screen->on_shown = new OnShown(std::move(on_shown));
  return GST_ELEMENT(screen);
}

}  // namespace spidar::bench
