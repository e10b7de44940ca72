// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The filter of spidar-feel and frames in GPU memory, by Mesa's renderer in software.
#include <gst/gst.h>

#include "plugin/feel/tracer/feel_bin.h"
#include "plugin/gobject/ref.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"

namespace spidar::test::small_copy_test {
namespace {

struct Outcome {
  std::vector<Wrench> felt;
  std::string error;
  int width_px = 0;  ///< of what was analysed
};

/// Plays a film through the filter. `upload`: the elements that bring its frames to where they are
/// when they come to the filter, with an exclamation mark behind. Their copies may be analysed
/// after the last frame is shown: `frames` are waited for.
Outcome play(const std::string& upload, size_t frames = 0) {
  init_gstreamer();
  // Without a display.
  g_setenv("GST_GL_PLATFORM", "egl", TRUE);
  g_setenv("GST_GL_WINDOW", "egl-device", TRUE);
  g_setenv("LIBGL_ALWAYS_SOFTWARE", "1", TRUE);
  const std::string film =
      "videotestsrc pattern=ball num-buffers=12 ! "
      "video/x-raw,format=I420,width=1708,height=960,framerate=25/1 ! " +
      upload + " identity name=shown ! fakesink name=screen";
  const Ref<GstElement> pipeline = sunk(gst_parse_launch(film.c_str(), nullptr));
  Outcome outcome;
  if (!pipeline) {
    outcome.error = "an element is missing";
    return outcome;
  }
  const auto part = [&pipeline](const char* name) {
    return Ref<GstElement>(gst_bin_get_by_name(GST_BIN(pipeline.get()), name));
  };
  const Ref<GstElement> shown = part("shown"), screen = part("screen");
  GstElement* const bin = gst_spidar_feel_bin_new("device=none\nfilter-min-cutoff=0");
  gst_element_unlink(shown.get(), screen.get());
  gst_bin_add(GST_BIN(pipeline.get()), bin);
  gst_element_link_many(shown.get(), bin, screen.get(), nullptr);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const Ref<GstBus> bus(gst_element_get_bus(pipeline.get()));
  bool is_over = false;
  while (!is_over || (outcome.felt.size() < frames && outcome.error.empty())) {
    GstMessage* const message = gst_bus_timed_pop_filtered(
        bus.get(), 60 * GST_SECOND,
        static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR | GST_MESSAGE_ELEMENT));
    if (!message) {
      outcome.error = "nothing comes";
      break;
    }
    is_over = is_over || GST_MESSAGE_TYPE(message) != GST_MESSAGE_ELEMENT;
    if (gst_message_has_name(message, "spidar-motion")) {
      outcome.felt.push_back(parse_motion_message(message).wrench);
      guint width = 0;
      gst_structure_get_uint(gst_message_get_structure(message), "area-width", &width);
      outcome.width_px = static_cast<int>(width);
    }
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
      GError* error = nullptr;
      gst_message_parse_error(message, &error, nullptr);
      outcome.error = error->message;
      g_clear_error(&error);
    }
    gst_message_unref(message);
  }
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return outcome;
}

TEST(SmallCopy, OfFramesInGpuMemoryFeelsAsTheFramesDo) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "Mesa's renderer does not give back all its memory";
#endif
  const Outcome plain = play("");
  ASSERT_EQ(plain.error, "");
  ASSERT_EQ(plain.width_px, 1708);
  const Outcome in_gpu = play("glupload ! video/x-raw(memory:GLMemory) !", plain.felt.size());
  if (!in_gpu.error.empty() || in_gpu.felt.empty()) {
    const Outcome without = play("glupload ! gldownload !");
    if (!without.error.empty()) GTEST_SKIP() << "GL does not work here: " << without.error;
  }
  EXPECT_EQ(in_gpu.error, "");
  EXPECT_EQ(in_gpu.width_px, 854);
  double largest_N = 0;
  for (const Wrench& wrench : plain.felt) largest_N = std::max(largest_N, wrench.force_N.norm());
  ASSERT_GT(largest_N, 0);
  ASSERT_EQ(in_gpu.felt.size(), plain.felt.size());
  // The ball moves by 13 pixels of the copy to the right, so 0.1 px more or less is below 1 %.
  for (size_t i = 0; i < plain.felt.size(); ++i) {
    EXPECT_LT((in_gpu.felt[i].force_N - plain.felt[i].force_N).norm(), 0.02 * largest_N) << i;
  }
}

}  // namespace
}  // namespace spidar::test::small_copy_test
