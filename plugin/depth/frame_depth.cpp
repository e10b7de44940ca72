// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/frame_depth.h"

#include <stdexcept>

#include <gst-spidar/gstspidardepthmeta.h>
#include <gst/video/video.h>

namespace spidar {
namespace {

DepthSettings settings_of(const GstSpidarDepthImage& image) {
  const DepthSettings settings{image.disparity != FALSE, image.near_sample, image.far_sample};
  try {
    validate(settings);
  } catch (const std::invalid_argument&) {
    return {settings.disparity, -1, -1};
  }
  return settings;
}

}  // namespace

bool read_frame_depth(GstBuffer* frame, double dt_s, DepthPicture& picture) {
  GstSpidarDepthImage image;
  GstVideoFrame mapped;
  if (!gst_buffer_get_spidar_depth(frame, &image) ||
      !gst_video_frame_map(&mapped, &image.info, image.buffer, GST_MAP_READ)) {
    return false;
  }
  DepthView view;
  view.data = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&mapped, 0));
  view.width = GST_VIDEO_FRAME_WIDTH(&mapped);
  view.height = GST_VIDEO_FRAME_HEIGHT(&mapped);
  view.stride_bytes = GST_VIDEO_FRAME_PLANE_STRIDE(&mapped, 0);
  view.bytes = GST_VIDEO_FRAME_COMP_PSTRIDE(&mapped, 0);
  view.big_endian = GST_VIDEO_FRAME_FORMAT(&mapped) == GST_VIDEO_FORMAT_GRAY16_BE;
  const bool read = picture.read(view, settings_of(image), dt_s);
  gst_video_frame_unmap(&mapped);
  return read;
}

}  // namespace spidar
