// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/track/luma_reader.h"

#include <stdexcept>

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include "apps/film/failure.h"
#include "apps/film/film_uri.h"

namespace {

/// 8-bit formats whose first plane is the luma; others are converted to the first of these.
constexpr const char* kPipeline =
    "uridecodebin name=source expose-all-streams=false caps=video/x-raw(ANY) ! videoconvert ! "
    "video/x-raw,format={GRAY8,I420,YV12,NV12,NV21,Y42B,Y444,NV16,NV24,Y41B} ! "
    "appsink name=sink sync=false max-buffers=4";

}  // namespace

struct LumaReader::Impl {
  std::string name;
  std::string uri;
  bool seen = false;  ///< there was a frame
  GstElement* pipeline = nullptr;
  GstElement* sink = nullptr;
  GstSample* sample = nullptr;  ///< the sample to which `mapped` belongs
  GstVideoFrame mapped{};

  void release() {
    if (!sample) return;
    gst_video_frame_unmap(&mapped);
    gst_sample_unref(sample);
    sample = nullptr;
  }
  ~Impl() {
    release();
    if (sink) gst_object_unref(sink);
    if (!pipeline) return;
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error(name + ": " + reason);
  }
  void fail_on_error() {
    GstBus* bus = gst_element_get_bus(pipeline);
    GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    gst_object_unref(bus);
    if (!message) return;
    const std::string reason = misses_sound_only(message) ? kNoVideo : failure_text(message, uri);
    gst_message_unref(message);
    fail(reason);
  }
};

LumaReader::LumaReader(const std::string& video) : impl_(std::make_unique<Impl>()) {
  impl_->name = video;
  impl_->uri = film_uri(video);
  GError* error = nullptr;
  impl_->pipeline = gst_parse_launch(kPipeline, &error);
  if (error) {
    const std::string reason = error->message;
    g_error_free(error);
    impl_->fail("GStreamer: " + reason);
  }
  GstElement* source = gst_bin_get_by_name(GST_BIN(impl_->pipeline), "source");
  g_object_set(source, "uri", impl_->uri.c_str(), nullptr);
  gst_object_unref(source);
  impl_->sink = gst_bin_get_by_name(GST_BIN(impl_->pipeline), "sink");
  gst_element_set_state(impl_->pipeline, GST_STATE_PLAYING);
}

LumaReader::~LumaReader() = default;

bool LumaReader::next(Frame& frame) {
  impl_->release();
  // Returns without a sample at the end, and when the pipeline fails.
  GstSample* sample = nullptr;
  while (!sample) {
    sample = gst_app_sink_try_pull_sample(GST_APP_SINK(impl_->sink), 100 * GST_MSECOND);
    if (sample) break;
    impl_->fail_on_error();
    if (!gst_app_sink_is_eos(GST_APP_SINK(impl_->sink))) continue;
    if (!impl_->seen) impl_->fail(kNoVideo);
    return false;
  }
  impl_->seen = true;
  GstVideoInfo info;
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&impl_->mapped, &info, buffer, GST_MAP_READ)) {
    gst_sample_unref(sample);
    impl_->fail("a frame cannot be read");
  }
  impl_->sample = sample;
  const GstSegment* segment = gst_sample_get_segment(sample);
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  const GstClockTime running = gst_segment_to_running_time(segment, GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(running)) impl_->fail("a frame has no time");
  frame.running_time_ns = static_cast<int64_t>(running);
  frame.stream_time_ns =
      static_cast<int64_t>(gst_segment_to_stream_time(segment, GST_FORMAT_TIME, pts));
  frame.luma = {static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&impl_->mapped, 0)),
                GST_VIDEO_FRAME_WIDTH(&impl_->mapped), GST_VIDEO_FRAME_HEIGHT(&impl_->mapped),
                GST_VIDEO_FRAME_PLANE_STRIDE(&impl_->mapped, 0)};
  return true;
}
