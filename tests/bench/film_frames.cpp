// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/film_frames.h"

#include <cstring>
#include <stdexcept>

#include <gst/app/gstappsink.h>
#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include "tests/bench/gst_pipeline.h"

namespace spidar::bench {
namespace {

using test::Picture;

Picture picture_of(GstSample* sample) {
  GstVideoInfo info;
  GstVideoFrame frame;
  if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ)) {
    gst_sample_unref(sample);
    throw std::runtime_error("GStreamer gave a picture that cannot be read");
  }
  Picture picture(GST_VIDEO_FRAME_WIDTH(&frame), GST_VIDEO_FRAME_HEIGHT(&frame));
  const auto* from = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, 0));
  for (int y = 0; y < picture.height; ++y) {
    std::memcpy(&picture.at(0, y), from + ptrdiff_t{y} * GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0),
                static_cast<size_t>(picture.width));
  }
  gst_video_frame_unmap(&frame);
  gst_sample_unref(sample);
  return picture;
}

}  // namespace

std::vector<Picture> draw_all(test::Film& film, int frames) {
  std::vector<Picture> pictures;
  for (int n = 0; n < frames; ++n) {
    const ImageView view = film.draw(n);
    Picture picture(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
      std::memcpy(&picture.at(0, y), view.data + y * view.stride_bytes,
                  static_cast<size_t>(view.width));
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

std::vector<Picture> coded(const std::vector<Picture>& frames) {
  const Picture& first = frames.front();
  constexpr double kBitsPerPixel = 0.06;
  const double kbit_s = kBitsPerPixel * 30e-3 * first.width * first.height;
  const std::string encoder =
      "x264enc threads=1 speed-preset=veryfast bitrate=" + std::to_string(static_cast<int>(kbit_s));
  const std::string size =
      "width=" + std::to_string(first.width) + ",height=" + std::to_string(first.height);
  Pipeline pipeline("appsrc name=source format=time max-bytes=0 caps=video/x-raw,format=I420," +
                    size + ",framerate=30/1,colorimetry=bt709 ! " + encoder +
                    " ! avdec_h264 ! appsink name=sink sync=false");
  pipeline.play();
  const Element source = pipeline.by_name("source");
  for (size_t n = 0; n < frames.size(); ++n) {
    GstBuffer* buffer = i420_buffer(frames[n]);
    set_time(buffer, static_cast<int>(n), 30);
    gst_app_src_push_buffer(GST_APP_SRC(source.get()), buffer);
  }
  gst_app_src_end_of_stream(GST_APP_SRC(source.get()));
  const Element sink = pipeline.by_name("sink");
  std::vector<Picture> result;
  while (GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink.get()))) {
    result.push_back(picture_of(sample));
  }
  if (result.size() != frames.size()) {
    throw std::runtime_error("the encoder and avdec_h264 gave " + std::to_string(result.size()) +
                             " of " + std::to_string(frames.size()) +
                             " frames: " + pipeline.problem());
  }
  return result;
}

}  // namespace spidar::bench
