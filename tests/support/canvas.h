// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "plugin/frame/frame_report.h"
#include "plugin/overlay/video_overlay.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

/// Red, green and blue.
using Pixel = std::array<int, 3>;

/// A grey frame in memory to draw into, with watched pages on both sides.
class Canvas {
 public:
  Canvas(const char* format, int width, int height) {
    init_gstreamer();
    GstCaps* caps = make_caps(format, width, height);
    gst_video_info_from_caps(&info_, caps);
    gst_caps_unref(caps);
    buffer_ = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info_) + 2 * kGuard, nullptr);
    gst_buffer_memset(buffer_, 0, kGrey, gst_buffer_get_size(buffer_));
    gst_buffer_resize(buffer_, kGuard, static_cast<gssize>(GST_VIDEO_INFO_SIZE(&info_)));
    before_ = rgb();
  }
  ~Canvas() { gst_buffer_unref(buffer_); }

  void set_pixel_aspect(int width, int height) {
    GST_VIDEO_INFO_PAR_N(&info_) = width;
    GST_VIDEO_INFO_PAR_D(&info_) = height;
  }

  void draw(DrawnFrame report, double scale = 1, bool has_points = true,
            const ForceCurve* curve = nullptr) {
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info_, buffer_, GST_MAP_READWRITE));
    report.visible = visible_part(frame);
    FilmPlace& place = report.frame.place;
    if (place.picture_width == 0) {
      place = FilmPlace::whole(report.visible.width, report.visible.height);
    }
    draw_overlay(report, has_points, scale, frame, curve);
    gst_video_frame_unmap(&frame);
    after_ = rgb();
  }

  Pixel at(int x, int y) const { return read(after_, x, y); }
  bool is_drawn(int x, int y) const { return at(x, y) != read(before_, x, y); }

  bool guards_hold() {
    gsize offset, most;
    gst_buffer_get_sizes(buffer_, &offset, &most);
    const gsize size = gst_buffer_get_size(buffer_);
    gst_buffer_resize(buffer_, -static_cast<gssize>(kGuard), static_cast<gssize>(most));
    GstMapInfo map;
    gst_buffer_map(buffer_, &map, GST_MAP_READ);
    bool hold = true;
    for (gsize i = 0; i < kGuard; ++i) {
      hold = hold && map.data[i] == kGrey && map.data[kGuard + size + i] == kGrey;
    }
    gst_buffer_unmap(buffer_, &map);
    gst_buffer_resize(buffer_, kGuard, static_cast<gssize>(size));
    return hold;
  }

 private:
  static constexpr gsize kGuard = 4096;
  static constexpr guint8 kGrey = 77;

  Pixel read(const std::vector<uint8_t>& pixels, int x, int y) const {
    const size_t first = 3 * static_cast<size_t>(y * GST_VIDEO_INFO_WIDTH(&info_) + x);
    return {pixels[first], pixels[first + 1], pixels[first + 2]};
  }
  /// The frame in RGB, without padding.
  std::vector<uint8_t> rgb() {
    const int width = GST_VIDEO_INFO_WIDTH(&info_), height = GST_VIDEO_INFO_HEIGHT(&info_);
    GstVideoInfo wanted;
    gst_video_info_set_format(&wanted, GST_VIDEO_FORMAT_RGB, static_cast<guint>(width),
                              static_cast<guint>(height));
    wanted.fps_n = info_.fps_n;
    wanted.fps_d = info_.fps_d;
    wanted.par_n = info_.par_n;
    wanted.par_d = info_.par_d;
    GstBuffer* const converted =
        gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&wanted), nullptr);
    GstVideoFrame from, to;
    EXPECT_TRUE(gst_video_frame_map(&from, &info_, buffer_, GST_MAP_READ));
    EXPECT_TRUE(gst_video_frame_map(&to, &wanted, converted, GST_MAP_WRITE));
    GstVideoConverter* const converter = gst_video_converter_new(&info_, &wanted, nullptr);
    gst_video_converter_frame(converter, &from, &to);
    gst_video_converter_free(converter);
    const ptrdiff_t stride = GST_VIDEO_FRAME_PLANE_STRIDE(&to, 0);
    const auto* const first = static_cast<const uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&to, 0));
    std::vector<uint8_t> pixels;
    for (int y = 0; y < height; ++y) {
      pixels.insert(pixels.end(), first + y * stride, first + y * stride + 3 * width);
    }
    gst_video_frame_unmap(&to);
    gst_video_frame_unmap(&from);
    gst_buffer_unref(converted);
    return pixels;
  }

  GstVideoInfo info_;
  GstBuffer* buffer_;
  std::vector<uint8_t> before_, after_;
};

}  // namespace spidar::test
