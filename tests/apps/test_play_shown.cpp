// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The player counts the frames of every sink that autovideosink may choose. Each test plays in a
/// process of its own, because the count goes on until a process ends. Criticals end it.

#include <atomic>
#include <climits>
#include <cstdlib>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "apps/play/pipeline.h"
#include "apps/play/shown_frames.h"

namespace {

constexpr int kFrames = 10;

/// A sink that is no GstBaseSink and has no statistics.
struct PlainSink {
  GstElement parent;
};
struct PlainSinkClass {
  GstElementClass parent_class;
};
G_DEFINE_TYPE(PlainSink, plain_sink, GST_TYPE_ELEMENT)
void plain_sink_class_init(PlainSinkClass* klass) {
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "plain", "Sink", "plain", "test");
}
GstFlowReturn plain_sink_take(GstPad*, GstObject*, GstBuffer* buffer) {
  gst_buffer_unref(buffer);
  return GST_FLOW_OK;
}
void plain_sink_init(PlainSink* self) {
  GST_OBJECT_FLAG_SET(self, GST_ELEMENT_FLAG_SINK);
  GstPad* const pad = gst_pad_new("sink", GST_PAD_SINK);
  gst_pad_set_chain_function(pad, plain_sink_take);
  gst_element_add_pad(GST_ELEMENT(self), pad);
}

/// A sink that is a bin, as glimagesink is.
struct SinkBin {
  GstBin parent;
};
struct SinkBinClass {
  GstBinClass parent_class;
};
GType type_inside;
G_DEFINE_TYPE(SinkBin, sink_bin, GST_TYPE_BIN)
void sink_bin_class_init(SinkBinClass* klass) {
  static GstStaticPadTemplate any =
      GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "bin", "Sink/Video", "bin",
                                        "test");
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &any);
}
void sink_bin_init(SinkBin* self) {
  auto* const inside = GST_ELEMENT(g_object_new(type_inside, nullptr));
  gst_bin_add(GST_BIN(self), inside);
  GstPad* const pad = gst_element_get_static_pad(inside, "sink");
  gst_element_add_pad(GST_ELEMENT(self), gst_ghost_pad_new("sink", pad));
  gst_object_unref(pad);
}

/// Ends the process: 0 when every frame was counted.
[[noreturn]] void play_into_bin_of(const char* factory_inside) {
  gst_init(nullptr, nullptr);
  setenv("DISPLAY", ":no-such-display", 1);  // nothing opens it
  type_inside = plain_sink_get_type();
  if (factory_inside != nullptr) {
    GstElement* const example = gst_element_factory_make(factory_inside, nullptr);
    type_inside = G_OBJECT_TYPE(example);
    gst_object_unref(gst_object_ref_sink(example));
  }
  gst_element_register(nullptr, "sinkbin", INT_MAX, sink_bin_get_type());
  const Screen screen = open_screen(false);
  if (screen.sink == nullptr || G_OBJECT_TYPE(screen.sink) != type_inside) std::_Exit(1);

  GstElement* const source = gst_element_factory_make("videotestsrc", nullptr);
  g_object_set(source, "num-buffers", kFrames, nullptr);
  GstElement* const pipeline = gst_pipeline_new(nullptr);
  gst_bin_add_many(GST_BIN(pipeline), source, screen.element, nullptr);
  gst_element_link(source, screen.element);
  static std::atomic<int> shown{0};
  static std::atomic<bool> ended{false};
  watch_shown_frames(screen.sink, [](int64_t, int64_t) { ++shown; });
  GstPad* const pad = gst_element_get_static_pad(screen.sink, "sink");
  gst_pad_add_probe(
      pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer) {
        if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_EOS) ended = true;
        return GST_PAD_PROBE_OK;
      },
      nullptr, nullptr);
  gst_object_unref(pad);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  while (!ended) g_usleep(1000);
  std::_Exit(shown == kFrames ? 0 : 2);
}

TEST(ShownFrames, OfASinkInABin) {
  EXPECT_EXIT(play_into_bin_of("fakesink"), testing::ExitedWithCode(0), "");
}

TEST(ShownFrames, OfASinkWithoutStatistics) {
  EXPECT_EXIT(play_into_bin_of(nullptr), testing::ExitedWithCode(0), "");
}

}  // namespace
