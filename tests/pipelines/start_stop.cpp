// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Starts, plays and stops a pipeline once, for Valgrind.
#include <cstdio>

#include <gst/gst.h>

namespace {

/// True when the stream came to its end.
bool play() {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      "videotestsrc num-buffers=5 pattern=ball ! video/x-raw,format=I420,width=160,height=120 ! "
      "spidarmotion overlay=points attach-meta=true ! queue ! fakesink sync=true",
      &error);
  if (error) {
    std::fprintf(stderr, "error: %s\n", error->message);
    g_error_free(error);
    return false;
  }
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  const bool ended = GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS;
  gst_message_unref(message);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(pipeline);
  return ended;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  const bool ended = play();
  gst_deinit();
  return ended ? 0 : 1;
}
