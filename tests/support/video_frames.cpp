// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/video_frames.h"

#include <cmath>
#include <cstring>

#include "tests/support/texture.h"
#include "tests/support/video_formats.h"

namespace spidar::test {

double texture(double x, double y) {
  static const Texture picture(1, 7.0);
  return picture.at(x, y);
}

GstBuffer* make_picture(const GstVideoInfo& info, const GreyAt& grey, int plane0_extra_stride) {
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {};
  const guint planes = GST_VIDEO_INFO_N_PLANES(&info);
  gsize size = 0;
  for (guint p = 0; p < planes; ++p) {
    offset[p] = size;
    stride[p] = GST_VIDEO_INFO_PLANE_STRIDE(&info, p) + (p == 0 ? plane0_extra_stride : 0);
    // A full frame's height is enough for every plane of the formats in use.
    size += static_cast<gsize>(stride[p]) * static_cast<gsize>(GST_VIDEO_INFO_HEIGHT(&info));
  }
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  gst_buffer_memset(buffer, 0, 128, size);
  gst_buffer_add_video_meta_full(buffer, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_INFO_FORMAT(&info),
                                 static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info)),
                                 static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info)), planes, offset,
                                 stride);
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_WRITE);
  const int pixel_stride = GST_VIDEO_INFO_COMP_PSTRIDE(&info, 0);
  const bool is_rgb = GST_VIDEO_INFO_IS_RGB(&info);
  for (int y = 0; y < GST_VIDEO_INFO_HEIGHT(&info); ++y) {
    guint8* line = map.data + static_cast<gsize>(stride[0]) * static_cast<gsize>(y);
    for (int x = 0; x < GST_VIDEO_INFO_WIDTH(&info); ++x) {
      const auto level = static_cast<guint>(std::lround(grey(x, y)));
      if (is_rgb) {
        std::memset(line + x * pixel_stride, static_cast<int>(level),
                    static_cast<size_t>(pixel_stride));
      } else {
        write_sample(*info.finfo, 0, level, static_cast<guint>(x), line + x * pixel_stride);
      }
    }
  }
  gst_buffer_unmap(buffer, &map);
  return buffer;
}

GstBuffer* make_frame(const GstVideoInfo& info, double dx, double dy, int plane0_extra_stride) {
  return make_picture(
      info, [&](int x, int y) { return texture(x - dx, y - dy); }, plane0_extra_stride);
}

GstCaps* make_caps(const char* format, int width, int height, int fps_n, int fps_d) {
  return gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, format, "width", G_TYPE_INT,
                             width, "height", G_TYPE_INT, height, "framerate", GST_TYPE_FRACTION,
                             fps_n, fps_d, nullptr);
}

}  // namespace spidar::test
