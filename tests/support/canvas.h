// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A frame to draw into, whose pixels are read back.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/filter/frame/scene_view.h"
#include "plugin/filter/overlay/arrow.h"
#include "plugin/filter/overlay/video_overlay.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

using Pixel = std::array<int, 3>;

/// A grey frame in memory that is watched on both sides.
class Canvas {
 public:
  Canvas(const char* format, int width, int height, const char* colorimetry = nullptr) {
    init_gstreamer();
    GstCaps* caps = make_caps(format, width, height);
    if (colorimetry) {
      gst_caps_set_simple(caps, "colorimetry", G_TYPE_STRING, colorimetry, nullptr);
    }
    gst_video_info_from_caps(&info_, caps);
    gst_caps_unref(caps);
    buffer_ = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info_) + 2 * kGuard, nullptr);
    gst_buffer_memset(buffer_, 0, kGrey, gst_buffer_get_size(buffer_));
    gst_buffer_resize(buffer_, kGuard, static_cast<gssize>(GST_VIDEO_INFO_SIZE(&info_)));
  }
  ~Canvas() { gst_buffer_unref(buffer_); }

  void set_pixel_aspect(int width, int height) {
    GST_VIDEO_INFO_PAR_N(&info_) = width;
    GST_VIDEO_INFO_PAR_D(&info_) = height;
  }

  template <typename Work>
  void with_frame(Work&& work) {
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info_, buffer_, GST_MAP_READWRITE));
    work(frame);
    gst_video_frame_unmap(&frame);
  }

  void draw(const SceneView& scene, double scale = 1, double max_force_N = 3,
            const std::optional<TouchMark>& touch = std::nullopt,
            const std::vector<uint32_t>& felt = {}) {
    with_frame([&](GstVideoFrame& frame) {
      draw_overlay(scene, true, felt, visible_part(frame), scale, max_force_N, touch, frame);
    });
  }

  /// As many of the three as the format has; the others 0.
  Pixel at(int x, int y) {
    Pixel pixel{};
    with_frame([&](GstVideoFrame& frame) {
      for (guint c = 0; c < std::min(GST_VIDEO_FRAME_N_COMPONENTS(&frame), 3u); ++c) {
        const auto plane = static_cast<guint>(GST_VIDEO_FRAME_COMP_PLANE(&frame, c));
        const auto* data = static_cast<const guint8*>(GST_VIDEO_FRAME_PLANE_DATA(&frame, plane)) +
                           component_offset(*info_.finfo, c);
        const ptrdiff_t row = y >> GST_VIDEO_FORMAT_INFO_H_SUB(info_.finfo, c);
        const ptrdiff_t column = x >> GST_VIDEO_FORMAT_INFO_W_SUB(info_.finfo, c);
        pixel[c] =
            static_cast<int>(read_sample(*info_.finfo, c,
                                         data + row * GST_VIDEO_FRAME_COMP_STRIDE(&frame, c) +
                                             column * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c)));
      }
    });
    return pixel;
  }

  Pixel untouched() const {
    Pixel pixel{};
    const std::array<guint8, 2> sample{kGrey, kGrey};
    for (guint c = 0; c < std::min(GST_VIDEO_INFO_N_COMPONENTS(&info_), 3u); ++c) {
      pixel[c] = static_cast<int>(read_sample(*info_.finfo, c, sample.data()));
    }
    return pixel;
  }

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

  static constexpr guint8 kGrey = 77;

 private:
  static constexpr gsize kGuard = 4096;
  GstVideoInfo info_;
  GstBuffer* buffer_;
};

}  // namespace spidar::test
