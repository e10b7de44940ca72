// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A spidardepth with a harness at each of its sink pads.
#pragma once

#include <string>
#include <thread>
#include <vector>

#include <gst-spidar/gstspidardepthmeta.h>
#include <gst/check/gstharness.h>
#include <gst/video/video.h>
#include <gtest/gtest.h>

#include "plugin/depth/spidar_depth.h"

extern "C" gint first_sample_in_c(GstBuffer* frame);

namespace spidar::test {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr const char* kVideo = "video/x-raw,format=RGB,width=16,height=16,framerate=25/1";
constexpr const char* kDepth = "video/x-raw,format=GRAY16_LE,width=8,height=4,framerate=25/1";

inline GstBuffer* make_buffer(GstClockTime pts, gsize bytes, guint8 fill,
                              GstClockTime duration = kFrame) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bytes, nullptr);
  gst_buffer_memset(buffer, 0, fill, bytes);
  GST_BUFFER_PTS(buffer) = pts;
  GST_BUFFER_DURATION(buffer) = duration;
  return buffer;
}
inline GstBuffer* video_frame(GstClockTime pts) {
  return make_buffer(pts, 16 * 48, 0x5a);
}
inline GstBuffer* depth_image(GstClockTime pts, GstClockTime duration = kFrame) {
  return make_buffer(pts, 64, static_cast<guint8>(pts / kFrame), duration);
}

/// An output frame, and the depth on it.
struct Shown {
  GstClockTime pts = 0;
  bool has_depth = false;
  GstSpidarDepthImage depth{};  ///< without its buffer
  int first_sample = -1;        ///< first byte of the depth
};

class DepthHarness : public testing::Test {
 protected:
  void SetUp() override {
    static const bool registered = [] {
      gst_init(nullptr, nullptr);
      return GST_ELEMENT_REGISTER(spidardepth, nullptr) != FALSE;
    }();
    ASSERT_TRUE(registered);
    open("");
  }
  void TearDown() override { close(); }

  /// Properties as in a launch line.
  void open(const std::string& properties) {
    close();
    element = gst_parse_launch(("spidardepth " + properties).c_str(), nullptr);
    ASSERT_NE(element, nullptr);
    bus = gst_bus_new();
    gst_element_set_bus(element, bus);
    video = gst_harness_new_with_element(element, "sink", "src");
    depth = gst_harness_new_with_element(element, "depth_sink", nullptr);
    set_live(false);
    gst_harness_set_src_caps_str(video, kVideo);
    gst_harness_set_src_caps_str(depth, kDepth);
  }

  void set_live(bool live) {
    gst_harness_set_live(video, live);
    gst_harness_set_live(depth, live);
  }

  void close() {
    if (!video) return;
    gst_element_set_state(element, GST_STATE_NULL);  // releases threads that wait
    if (depth_thread.joinable()) depth_thread.join();
    if (video_thread.joinable()) video_thread.join();
    gst_harness_teardown(depth);
    gst_harness_teardown(video);
    gst_bus_set_flushing(bus, TRUE);
    gst_object_unref(bus);
    gst_object_unref(element);
    video = depth = nullptr;
  }

  /// Pushes these in a thread of their own, followed by EOS if `ends`.
  void push_depth(std::vector<GstBuffer*> images, bool ends = true) {
    if (depth_thread.joinable()) depth_thread.join();
    depth_thread = std::thread([this, images, ends] {
      depth_flow = GST_FLOW_OK;
      for (GstBuffer* image : images) {
        if (depth_flow == GST_FLOW_OK) {
          depth_flow = gst_harness_push(depth, image);
        } else {
          gst_buffer_unref(image);
        }
      }
      if (ends) gst_harness_push_event(depth, gst_event_new_eos());
    });
  }
  void push_depth(GstClockTime first, GstClockTime length, int count) {
    std::vector<GstBuffer*> images;
    for (int n = 0; n < count; ++n) {
      images.push_back(depth_image(first + static_cast<GstClockTime>(n) * length, length));
    }
    push_depth(images);
  }

  void push_video(int frames) {
    for (int n = 0; n < frames; ++n) {
      ASSERT_EQ(gst_harness_push(video, video_frame(static_cast<GstClockTime>(n) * kFrame)),
                GST_FLOW_OK);
    }
  }

  std::vector<Shown> shown() {
    std::vector<Shown> all;
    while (GstBuffer* buffer = gst_harness_try_pull(video)) {
      Shown one;
      one.pts = GST_BUFFER_PTS(buffer);
      one.has_depth = gst_buffer_get_spidar_depth(buffer, &one.depth) != FALSE;
      one.first_sample = first_sample_in_c(buffer);
      one.depth.buffer = nullptr;
      gst_buffer_unref(buffer);
      all.push_back(one);
    }
    return all;
  }

  std::string next_message(GstMessageType type) {
    GstMessage* message = gst_bus_pop_filtered(bus, type);
    if (!message) return {};
    GError* error = nullptr;
    if (type == GST_MESSAGE_ERROR) {
      gst_message_parse_error(message, &error, nullptr);
    } else {
      gst_message_parse_warning(message, &error, nullptr);
    }
    std::string text = error->message;
    g_error_free(error);
    gst_message_unref(message);
    return text;
  }

  GstElement* element = nullptr;
  GstBus* bus = nullptr;
  GstHarness* video = nullptr;
  GstHarness* depth = nullptr;
  std::thread depth_thread;
  std::thread video_thread;
  GstFlowReturn depth_flow = GST_FLOW_OK;
};

}  // namespace spidar::test
