// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Whole pipelines as users launch them, with the plugin as GStreamer loads it.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/launched.h"

namespace spidar::test::launch_test {
namespace {

class Launch : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    gst_init(nullptr, nullptr);
    std::string name = (std::filesystem::temp_directory_path() / "spidar-XXXXXX").string();
    folder = mkdtemp(name.data());
    clip = (folder / "clip.avi").string();
    ASSERT_TRUE(launch("videotestsrc num-buffers=30 pattern=ball ! "
                       "video/x-raw,width=320,height=240,framerate=25/1 ! jpegenc ! avimux ! "
                       "filesink location=" +
                       clip)
                    .eos);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder); }

  static std::filesystem::path folder;
  static std::string clip;
};
std::filesystem::path Launch::folder;
std::string Launch::clip;

TEST_F(Launch, EveryTestPattern) {
  for (const char* pattern :
       {"ball", "smpte", "snow", "black", "white", "checkers-1", "checkers-8", "circular", "blink",
        "zone-plate", "gamut", "gradient", "pinwheel", "spokes", "solid-color"}) {
    SCOPED_TRACE(pattern);
    const Outcome outcome = launch(std::string("videotestsrc num-buffers=10 pattern=") + pattern +
                                   " ! video/x-raw,width=320,height=240 ! spidarmotion ! fakesink");
    EXPECT_TRUE(outcome.eos) << outcome.error;
    EXPECT_TRUE(outcome.warnings.empty());
    EXPECT_EQ(outcome.motions, 10);
  }
}

TEST_F(Launch, OtherFormatsNeedAConverter) {
  const std::string source = "videotestsrc num-buffers=3 ! video/x-raw,format=RGB16 ! ";
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch((source + "spidarmotion ! fakesink").c_str(), &error);
  EXPECT_NE(error, nullptr);
  g_clear_error(&error);
  if (pipeline) gst_object_unref(gst_object_ref_sink(pipeline));
  EXPECT_TRUE(launch(source + "videoconvert ! spidarmotion ! fakesink").eos);
}

TEST_F(Launch, PlaybinWithVideoFilter) {
  for (const char* player : {"playbin", "playbin3"}) {
    SCOPED_TRACE(player);
    GstElement* playbin = gst_element_factory_make(player, nullptr);
    ASSERT_NE(playbin, nullptr);
    GstElement* filter = gst_element_factory_make("spidarmotion", nullptr);
    ASSERT_NE(filter, nullptr);
    GstElement* sink = gst_element_factory_make("fakesink", nullptr);
    gchar* uri = gst_filename_to_uri(clip.c_str(), nullptr);
    g_object_set(playbin, "uri", uri, "video-filter", filter, "video-sink", sink, nullptr);
    g_free(uri);
    const Outcome outcome = run_to_end(playbin);
    EXPECT_TRUE(outcome.eos) << outcome.error;
    EXPECT_EQ(outcome.motions, 30);
    EXPECT_GT(outcome.largest_force_N, 0.1);
  }
}

TEST_F(Launch, CorruptVideoIsSurvived) {
  std::ifstream in(clip, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  uint32_t random = 1;
  for (size_t i = 4096; i < bytes.size(); ++i) {
    random = random * 1664525u + 1013904223u;
    if (random >> 24 == 0) bytes[i] = static_cast<char>(random >> 8);
  }
  const std::string corrupt = (folder / "corrupt.avi").string();
  std::ofstream(corrupt, std::ios::binary) << bytes;
  const Outcome outcome = launch("filesrc location=" + corrupt +
                                 " ! decodebin ! videoconvert ! spidarmotion ! fakesink");
  EXPECT_TRUE(outcome.eos || !outcome.error.empty());
}

TEST_F(Launch, TwoElementsInOnePipeline) {
  const Outcome outcome = launch(
      "videotestsrc num-buffers=10 pattern=ball ! video/x-raw,width=320,height=240 ! tee name=t "
      "t. ! queue ! spidarmotion ! fakesink t. ! queue ! spidarmotion controller=linear ! "
      "fakesink");
  EXPECT_TRUE(outcome.eos) << outcome.error;
  EXPECT_EQ(outcome.motions, 20);
}

TEST_F(Launch, TheSimulatedDeviceOfTheMonitorPlays) {
  GstDeviceMonitor* monitor = gst_device_monitor_new();
  ASSERT_NE(gst_device_monitor_add_filter(monitor, "Haptic/SPIDAR", nullptr), 0u)
      << "the plugin has no device provider";
  GstElement* element = nullptr;
  GList* devices = gst_device_monitor_get_devices(monitor);
  for (GList* item = devices; item; item = item->next) {
    GstStructure* properties = gst_device_get_properties(GST_DEVICE(item->data));
    if (g_strcmp0(gst_structure_get_string(properties, "device"), "sim") == 0)
      element = gst_device_create_element(GST_DEVICE(item->data), nullptr);
    gst_structure_free(properties);
  }
  g_list_free_full(devices, gst_object_unref);
  gst_object_unref(monitor);
  ASSERT_NE(element, nullptr);
  GstElement* pipeline = gst_pipeline_new(nullptr);
  GstElement* source = gst_parse_bin_from_description(
      "videotestsrc pattern=ball num-buffers=10 ! video/x-raw,width=320,height=240", TRUE, nullptr);
  GstElement* sink = gst_element_factory_make("fakesink", nullptr);
  gst_bin_add_many(GST_BIN(pipeline), source, element, sink, nullptr);
  ASSERT_TRUE(gst_element_link_many(source, element, sink, nullptr));
  const Outcome outcome = run_to_end(pipeline);
  EXPECT_TRUE(outcome.eos) << outcome.error;
  EXPECT_GT(outcome.motions, 0);
}

}  // namespace
}  // namespace spidar::test::launch_test
