// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of caps, events and buffers at the sink pad of spidarmotion. Each byte is one thing
// that comes to the pad, in any order. Nothing may crash or be critical (G_DEBUG=fatal-criticals),
// and each message has finite numbers.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>

#include "tests/support/element_harness.h"

using namespace spidar;
using namespace spidar::test;

namespace {

constexpr const char* kCaps[] = {
    "video/x-raw,format=GRAY8,width=64,height=48,framerate=25/1",
    "video/x-raw,format=I420,width=63,height=47,framerate=0/1",
    "video/x-raw,format=NV12,width=16,height=16,framerate=30/1,pixel-aspect-ratio=64/45",
    "video/x-raw,format=RGB,width=65,height=31,framerate=1/1000,interlace-mode=interleaved",
    "video/x-raw,format=P010_10LE,width=32,height=32,framerate=2147483647/1",
    "video/x-raw,format=YUY2,width=17,height=90,framerate=25/1,pixel-aspect-ratio=1/2147483647",
    "video/x-raw,format=GRAY8,width=8,height=8,framerate=25/1",
    "video/x-raw",
    "audio/x-raw,format=F32LE,rate=1000,channels=6",
};

constexpr GstClockTime kTimes[] = {0,           GST_SECOND, 40 * GST_MSECOND, 3600 * GST_SECOND,
                                   G_MAXUINT64, G_MAXINT64};

class Pad {
 public:
  explicit Pad(GstElement* element) : pad_(gst_element_get_static_pad(element, "sink")) {}
  ~Pad() { gst_object_unref(pad_); }
  Pad(const Pad&) = delete;
  Pad& operator=(const Pad&) = delete;

  /// As every element upstream begins.
  void begin() {
    send(gst_event_new_stream_start("fuzz"));
    push_caps(kCaps[0]);
    push_segment(4);
  }

  void take(uint8_t what) {
    const size_t detail = what / 8;
    switch (what % 8) {
      case 0:
        return push_caps(kCaps[detail % std::size(kCaps)]);
      case 1:
        return push_segment(detail);
      case 2:
        return send(gst_event_new_gap(kTimes[detail % 4], kTimes[detail / 4 % std::size(kTimes)]));
      case 3:
        send(gst_event_new_flush_start());
        return send(gst_event_new_flush_stop(detail % 2 == 0));
      case 4:
        return send(gst_event_new_tag(gst_tag_list_new(
            GST_TAG_IMAGE_ORIENTATION, detail % 2 == 0 ? "rotate-90" : "no orientation", nullptr)));
      case 5:
        return send(detail % 4 == 0 ? gst_event_new_eos() : gst_event_new_stream_start("fuzz"));
      default:
        return push_buffer(detail);
    }
  }

 private:
  void send(GstEvent* event) { gst_pad_send_event(pad_, event); }

  void push_caps(const char* text) {
    GstCaps* caps = gst_caps_from_string(text);
    if (gst_caps_is_fixed(caps)) send(gst_event_new_caps(caps));
    gst_video_info_init(&info_);
    gst_video_info_from_caps(&info_, caps);
    gst_caps_unref(caps);
  }

  void push_segment(size_t detail) {
    GstSegment segment;
    gst_segment_init(&segment, detail % 8 == 0 ? GST_FORMAT_BYTES : GST_FORMAT_TIME);
    constexpr double kRates[] = {1, -1, 0.001, 1e6};
    segment.rate = kRates[detail % std::size(kRates)];
    segment.start = kTimes[detail % 4];
    // GStreamer itself is critical of a segment that is played backwards from no end.
    const bool has_end = detail % 3 != 0 || segment.rate < 0;
    segment.stop = has_end ? segment.start + GST_SECOND : GST_CLOCK_TIME_NONE;
    segment.base = kTimes[detail / 4 % 4];
    send(gst_event_new_segment(&segment));
  }

  /// Mostly as large as the frame, and 40 ms after the one before.
  void push_buffer(size_t detail) {
    const gsize size = detail % 8 == 7 ? detail : GST_VIDEO_INFO_SIZE(&info_);
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
    gst_buffer_memset(buffer, 0, static_cast<guint8>(40 * detail), size);
    pts_ = detail % 8 == 6 ? kTimes[detail / 8 % std::size(kTimes)] : pts_ + 40 * GST_MSECOND;
    GST_BUFFER_PTS(buffer) = pts_;
    if (detail % 8 == 5) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_GAP);
    if (detail % 8 == 4) GST_BUFFER_DURATION(buffer) = kTimes[detail % std::size(kTimes)];
    gst_pad_chain(pad_, buffer);
  }

  GstPad* const pad_;
  GstVideoInfo info_{};
  GstClockTime pts_ = 0;
};

bool is_finite(const MotionMessage& message) {
  return std::isfinite(message.velocity_x) && std::isfinite(message.velocity_y) &&
         message.wrench.stacked().allFinite();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  init_gstreamer();
  ElementHarness element("device=none attach-meta=true");
  Pad pad(element.element());
  if (size % 2 == 1) pad.begin();
  for (size_t i = 0; i < size && i < 64; ++i) pad.take(data[i]);
  for (const MotionMessage& message : element.motions()) {
    if (is_finite(message)) continue;
    std::fputs("a message with a number that is none\n", stderr);
    std::abort();
  }
  return 0;
}
