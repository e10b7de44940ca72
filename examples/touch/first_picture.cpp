// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/touch/first_picture.h"

#include <memory>
#include <stdexcept>

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

namespace {

struct Stop {
  void operator()(GstElement* pipeline) const {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
};

/// Why the pipeline has failed; empty if it has not.
std::string failure_of(GstElement* pipeline) {
  GstBus* const bus = gst_element_get_bus(pipeline);
  GstMessage* const message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  gst_object_unref(bus);
  if (!message) return {};
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const std::string reason = error->message;
  g_error_free(error);
  gst_message_unref(message);
  return reason;
}

/// Returns no pixels when the frame cannot be read.
GreyPicture picture_of(GstSample* sample) {
  GreyPicture picture;
  GstVideoInfo info;
  GstVideoFrame frame;
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ)) {
    return picture;
  }
  picture.width = GST_VIDEO_FRAME_WIDTH(&frame);
  picture.height = GST_VIDEO_FRAME_HEIGHT(&frame);
  picture.stride_bytes = GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0);
  const auto* grey = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
  picture.pixels.assign(grey, grey + picture.height * picture.stride_bytes);
  gst_video_frame_unmap(&frame);
  return picture;
}

}  // namespace

GreyPicture first_picture(const std::string& file) {
  const std::unique_ptr<GstElement, Stop> pipeline(
      gst_parse_launch("filesrc name=source ! decodebin expose-all-streams=false ! videoconvert ! "
                       "video/x-raw,format=GRAY8 ! appsink name=sink sync=false max-buffers=1",
                       nullptr));
  GstElement* const source = gst_bin_get_by_name(GST_BIN(pipeline.get()), "source");
  g_object_set(source, "location", file.c_str(), nullptr);
  gst_object_unref(source);
  GstElement* const sink = gst_bin_get_by_name(GST_BIN(pipeline.get()), "sink");
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  // A pipeline that fails does not end.
  GstSample* sample = nullptr;
  std::string failure;
  while (!sample && failure.empty() && !gst_app_sink_is_eos(GST_APP_SINK(sink))) {
    sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 100 * GST_MSECOND);
    if (!sample) failure = failure_of(pipeline.get());
  }
  gst_object_unref(sink);
  GreyPicture picture;
  if (sample) {
    picture = picture_of(sample);
    gst_sample_unref(sample);
  }
  if (picture.pixels.empty()) {
    throw std::runtime_error(file + ": there is no picture in it. " + failure);
  }
  return picture;
}
