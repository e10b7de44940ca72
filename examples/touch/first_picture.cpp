// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/touch/first_picture.h"

#include <memory>
#include <stdexcept>

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include "examples/film/failure.h"
#include "examples/film/film_uri.h"

namespace {

/// 8-bit formats whose first plane is the luma; others are converted to the first of these.
constexpr const char* kPipeline =
    "uridecodebin name=source expose-all-streams=false caps=video/x-raw(ANY) ! videoconvert ! "
    "video/x-raw,format={GRAY8,I420,YV12,NV12,NV21,Y42B,Y444,NV16,NV24,Y41B} ! "
    "appsink name=sink sync=false max-buffers=1";

struct Stop {
  void operator()(GstElement* pipeline) const {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
};

/// Why the pipeline has failed; empty if it has not.
std::string failure_of(GstElement* pipeline, const std::string& uri) {
  GstBus* const bus = gst_element_get_bus(pipeline);
  GstMessage* const message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  gst_object_unref(bus);
  if (!message) return {};
  const std::string reason = misses_sound_only(message) ? kNoVideo : failure_text(message, uri);
  gst_message_unref(message);
  return reason;
}

/// No pixels when the frame cannot be read.
GreyPicture luma_of(GstSample* sample) {
  GreyPicture picture;
  GstVideoInfo info;
  GstVideoFrame frame;
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ)) {
    return picture;
  }
  picture.width = GST_VIDEO_FRAME_WIDTH(&frame);
  picture.height = GST_VIDEO_FRAME_HEIGHT(&frame);
  picture.stride_bytes = picture.width;
  const auto* row = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
  for (int y = 0; y < picture.height; ++y, row += GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0)) {
    picture.pixels.insert(picture.pixels.end(), row, row + picture.width);
  }
  gst_video_frame_unmap(&frame);
  return picture;
}

}  // namespace

GreyPicture first_picture(const std::string& file_or_uri) {
  const std::string uri = film_uri(file_or_uri);
  GError* error = nullptr;
  const std::unique_ptr<GstElement, Stop> pipeline(gst_parse_launch(kPipeline, &error));
  if (error) {
    const std::string reason = error->message;
    g_error_free(error);
    throw std::runtime_error("GStreamer: " + reason);
  }
  GstElement* const source = gst_bin_get_by_name(GST_BIN(pipeline.get()), "source");
  g_object_set(source, "uri", uri.c_str(), nullptr);
  gst_object_unref(source);
  GstElement* const sink = gst_bin_get_by_name(GST_BIN(pipeline.get()), "sink");
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  // A pipeline that fails does not end.
  GstSample* sample = nullptr;
  std::string failure;
  while (!sample && failure.empty() && !gst_app_sink_is_eos(GST_APP_SINK(sink))) {
    sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 100 * GST_MSECOND);
    if (!sample) failure = failure_of(pipeline.get(), uri);
  }
  gst_object_unref(sink);
  GreyPicture picture;
  if (sample) {
    picture = luma_of(sample);
    gst_sample_unref(sample);
  }
  if (picture.pixels.empty()) {
    throw std::runtime_error(file_or_uri + ": " + (failure.empty() ? kNoVideo : failure));
  }
  return picture;
}
