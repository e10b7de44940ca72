#include "tests/support/video_frames.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace spidar::test {

namespace {

/// Pseudo-random 0 … 1 for a lattice point.
double lattice(int x, int y) {
  uint32_t h = static_cast<uint32_t>(x) * 0x9E3779B1u ^ static_cast<uint32_t>(y) * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return static_cast<double>(h ^ (h >> 15)) / 4294967295.0;
}

/// Value noise: the lattice, smoothly interpolated. Continuous with its first derivative.
double noise(double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto fade = [](double t) { return t * t * (3 - 2 * t); };
  const double u = fade(x - fx), v = fade(y - fy);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  const double top = (1 - u) * lattice(ix, iy) + u * lattice(ix + 1, iy);
  const double bottom = (1 - u) * lattice(ix, iy + 1) + u * lattice(ix + 1, iy + 1);
  return (1 - v) * top + v * bottom;
}

}  // namespace

unsigned char texture(double x, double y) {
  // Two sizes of detail and no period: what looks alike is the same place.
  const double value = 0.5 * noise(x / 7.0, y / 7.0) + 0.5 * noise(x / 19.0 + 50, y / 19.0);
  return static_cast<unsigned char>(std::lround(30 + 195 * value));
}

GstBuffer* make_frame(const GstVideoInfo& info, double dx, double dy, int plane0_extra_stride) {
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
  for (int y = 0; y < GST_VIDEO_INFO_HEIGHT(&info); ++y) {
    guint8* line = map.data + static_cast<gsize>(stride[0]) * static_cast<gsize>(y);
    for (int x = 0; x < GST_VIDEO_INFO_WIDTH(&info); ++x) {
      std::memset(line + x * pixel_stride, texture(x - dx, y - dy),
                  static_cast<size_t>(pixel_stride));
    }
  }
  gst_buffer_unmap(buffer, &map);
  return buffer;
}

GstCaps* make_caps(const char* format, int width, int height, int fps_n, int fps_d) {
  return gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, format, "width", G_TYPE_INT,
                             width, "height", G_TYPE_INT, height, "framerate", GST_TYPE_FRACTION,
                             fps_n, fps_d, nullptr);
}

}  // namespace spidar::test
