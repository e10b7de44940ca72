// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// spidarextract on its own: frames with the meta of spidarmotion in, samples out.
#pragma once

#include <gst-spidar/gstspidarmotionmeta.h>
#include <gst/check/gstharness.h>

#include "core/track/track_format.h"
#include "plugin/filter/reports/motion_meta.h"
#include "plugin/tracks/track_elements.h"
#include "plugin/tracks/track_stream.h"
#include "tests/support/test.h"

namespace spidar::test {

inline constexpr GstClockTime kExtractedFrame = 40 * GST_MSECOND;
inline constexpr const char* kExtractedVideo =
    "video/x-raw,format=GRAY8,width=16,height=16,framerate=25/1";

inline Wrench wrench_of(double k) {
  return {{3 * std::sin(0.3 * k), std::cos(0.2 * k), 0.5 - k * 1e-3}, {0.1 * std::sin(k), 0, 0.02}};
}

inline GstBuffer* bare_frame(GstClockTime pts) {
  GstBuffer* frame = gst_buffer_new_allocate(nullptr, 256, nullptr);
  GST_BUFFER_PTS(frame) = pts;
  GST_BUFFER_DURATION(frame) = kExtractedFrame;
  return frame;
}

/// Whose motion is that of the time half of `interval` before the frame.
inline GstBuffer* make_frame(GstClockTime pts, const Wrench& wrench,
                             GstClockTime interval = kExtractedFrame) {
  GstBuffer* frame = bare_frame(pts);
  DrawnFrame report;
  report.stamp.running_ns = static_cast<int64_t>(pts);
  report.frame.interval_ns = static_cast<int64_t>(interval);
  report.frame.wrench = wrench;
  filter::attach_motion_meta(frame, report, 16, 16);
  return frame;
}

class Extract : public testing::Test {
 protected:
  void SetUp() override {
    static const bool registered = [] {
      gst_init(nullptr, nullptr);
      filter::register_motion_meta();
      return GST_ELEMENT_REGISTER(spidarextract, nullptr) != FALSE;
    }();
    ASSERT_TRUE(registered);
    open("wrench");
  }
  void TearDown() override { close(); }

  void open(const char* pad) {
    close();
    element = gst_element_factory_make("spidarextract", nullptr);
    bus = gst_bus_new();
    gst_element_set_bus(element, bus);
    h = gst_harness_new_with_element(element, "sink", pad);
    gst_harness_set_src_caps_str(h, kExtractedVideo);
  }

  void close() {
    if (!h) return;
    gst_harness_teardown(h);
    gst_bus_set_flushing(bus, TRUE);
    gst_object_unref(bus);
    gst_object_unref(element);
    h = nullptr;
  }

  void begin_segment(double rate, GstClockTime start, GstClockTime stop = GST_CLOCK_TIME_NONE) {
    push_segment({rate, start, stop, start, 0});
  }

  struct Part {
    double rate;
    GstClockTime start, stop, time, base;
  };
  void push_segment(const Part& part) {
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    segment.rate = part.rate;
    segment.start = segment.position = part.start;
    segment.stop = part.stop;
    segment.time = part.time;
    segment.base = part.base;
    ASSERT_TRUE(gst_harness_push_event(h, gst_event_new_segment(&segment)));
  }

  /// Frames number `first` to `last`, with the time stamps of the film `at` and one frame later,
  /// and with `interval` of running time between them.
  void push_frames(int first, int last, GstClockTime at, GstClockTime interval = kExtractedFrame) {
    for (int i = first; i <= last; ++i, at += kExtractedFrame)
      ASSERT_EQ(gst_harness_push(h, make_frame(at, wrench_of(i), interval)), GST_FLOW_OK);
  }

  /// Segments that came out since the last call.
  std::vector<GstSegment> take_segments() {
    std::vector<GstSegment> segments;
    while (GstEvent* event = gst_harness_try_pull_event(h)) {
      if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT)
        gst_event_copy_segment(event, &segments.emplace_back());
      gst_event_unref(event);
    }
    return segments;
  }

  void take_all() {
    while (GstBuffer* buffer = gst_harness_try_pull(h)) {
      GstMapInfo map;
      gst_buffer_map(buffer, &map, GST_MAP_READ);
      EXPECT_EQ(GST_BUFFER_DURATION(buffer), map.size / sizeof(TrackSample) * kTrackPeriod_ns);
      if (samples.empty()) begin = GST_BUFFER_PTS(buffer);
      EXPECT_EQ(GST_BUFFER_PTS(buffer), begin + samples.size() * kTrackPeriod_ns);
      bool silent = true;
      for (size_t at = 0; at < map.size; at += sizeof(TrackSample)) {
        TrackSample sample;
        std::memcpy(sample.data(), map.data + at, sizeof sample);
        for (float value : sample) silent = silent && value == 0;
        samples.push_back(sample);
      }
      EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP) != FALSE, silent);
      gst_buffer_unmap(buffer, &map);
      gst_buffer_unref(buffer);
    }
  }

  int warnings() {
    int count = 0;
    while (GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING)) {
      ++count;
      gst_message_unref(message);
    }
    return count;
  }

  /// The sample of the motion of frame `i`, which is shown `at_ms`: halfway to the one before.
  void expect_motion(size_t i, size_t at_ms, size_t interval_ms = 40) const {
    ASSERT_LT(at_ms, samples.size());
    EXPECT_EQ(samples[at_ms - interval_ms / 2], to_track_sample(wrench_of(static_cast<double>(i))))
        << i;
  }

  GstHarness* h = nullptr;
  GstElement* element = nullptr;
  GstBus* bus = nullptr;
  std::vector<TrackSample> samples;
  GstClockTime begin = 0;
};

}  // namespace spidar::test
