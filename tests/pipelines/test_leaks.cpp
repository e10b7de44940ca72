// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Starting and stopping leaks nothing, according to GStreamer's leak tracer.
#include <cstdio>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

namespace spidar::test {

namespace {

/// Collects the tracer's report when GStreamer is deinitialised: objects that are still alive.
std::vector<std::string> leaks;

void log_leak(GstDebugCategory*, GstDebugLevel, const gchar*, const gchar*, gint, GObject*,
              GstDebugMessage* message, gpointer) {
  const std::string text = gst_debug_message_get(message);
  if (text.find("object-alive") != std::string::npos) leaks.push_back(text);
}

/// Starts, stops and starts again, plays to the end of the stream, and releases the pipeline.
void play(const std::string& line) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  ASSERT_EQ(error, nullptr) << error->message;
  GstBus* bus = gst_element_get_bus(pipeline);
  for (const GstState state :
       {GST_STATE_PAUSED, GST_STATE_READY, GST_STATE_NULL, GST_STATE_PAUSED, GST_STATE_PLAYING}) {
    gst_element_set_state(pipeline, state);
    ASSERT_EQ(gst_element_get_state(pipeline, nullptr, nullptr, GST_CLOCK_TIME_NONE),
              GST_STATE_CHANGE_SUCCESS);
  }
  gst_element_seek_simple(pipeline, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  EXPECT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_EOS);
  gst_message_unref(message);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(pipeline);
}

TEST(Leaks, CyclesOfStartAndStop) {
  for (const char* motion : {"spidarmotion", "spidarmotion overlay=true attach-meta=true",
                             "spidarmotion device=none mute=true"}) {
    SCOPED_TRACE(motion);
    const std::string line =
        std::string(
            "videotestsrc num-buffers=8 pattern=ball ! video/x-raw,width=320,height=240 ! "
            "videoconvert ! ") +
        motion + " ! queue ! fakesink sync=false";
    for (int cycle = 0; cycle < 3; ++cycle) play(line);
  }
}

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  int failed = RUN_ALL_TESTS();
  if (argc > 1) gst_object_ref_sink(gst_bin_new("leaked on purpose"));  // see meson.build
  gst_debug_set_threshold_for_name("GST_TRACER", GST_LEVEL_TRACE);
  gst_debug_add_log_function(spidar::test::log_leak, nullptr, nullptr);
  gst_deinit();
  for (const std::string& leak : spidar::test::leaks) {
    std::fprintf(stderr, "leaked: %s\n", leak.c_str());
    failed = 1;
  }
  return failed;
}
