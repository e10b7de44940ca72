// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// All sequences of state changes, as in GStreamer's generic tests of elements.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/element_harness.h"

namespace spidar::test::states_test {
namespace {

constexpr GstState kNull = GST_STATE_NULL;
constexpr GstState kReady = GST_STATE_READY;
constexpr GstState kPaused = GST_STATE_PAUSED;
constexpr GstState kPlaying = GST_STATE_PLAYING;

const std::vector<std::vector<GstState>> kWays{
    {kReady, kPaused, kPlaying, kPaused, kReady, kNull, kReady, kPaused, kPlaying},
    {kPlaying, kPaused, kPlaying, kReady, kPlaying, kNull, kPlaying},
    {kReady, kNull, kReady, kPaused, kReady, kNull, kPaused, kNull},
    {kPlaying, kNull, kPlaying, kReady, kPaused, kNull},
};

TEST(States, EachIsReachedFromEachOther) {
  init_gstreamer();
  for (const char* device : {"none", "sim", "sim:sh4"}) {
    for (const std::vector<GstState>& way : kWays) {
      GstElement* element = gst_element_factory_make("spidarmotion", nullptr);
      gst_object_ref_sink(element);
      gst_util_set_object_arg(G_OBJECT(element), "device", device);
      if (std::string(device) == "sim:sh4") {
        g_object_set(element, "profile", "spidar-g6x3-v2-r", nullptr);
      }
      for (const GstState state : way) {
        SCOPED_TRACE(std::string(device) + " to " + gst_element_state_get_name(state));
        EXPECT_EQ(gst_element_set_state(element, state), GST_STATE_CHANGE_SUCCESS);
        GstState reached = GST_STATE_VOID_PENDING;
        EXPECT_EQ(gst_element_get_state(element, &reached, nullptr, 0), GST_STATE_CHANGE_SUCCESS);
        EXPECT_EQ(reached, state);
      }
      gst_element_set_state(element, GST_STATE_NULL);
      EXPECT_EQ(GST_OBJECT_REFCOUNT_VALUE(element), 1);
      gst_object_unref(element);
    }
  }
}

}  // namespace
}  // namespace spidar::test::states_test
