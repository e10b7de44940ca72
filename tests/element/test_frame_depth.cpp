// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// From the depth on a frame to levels and a relief.
#include <cstring>
#include <string>
#include <vector>

#include <gst/video/video.h>
#include <gtest/gtest.h>

#include "core/touch/relief.h"
#include "plugin/depth/depth_meta.h"
#include "plugin/depth/frame_depth.h"

namespace spidar::test::frame_depth_test {
namespace {

/// A frame with depth of this format: `near_half` on the right, `far_half` on the left.
GstBuffer* frame_with_depth(const char* format, int near_half, int far_half,
                            const DepthMeaning& meaning) {
  gst_init(nullptr, nullptr);
  register_depth_meta();
  // 38 samples wide: rows are padded to 4 bytes, so that stride and width differ.
  GstCaps* caps = gst_caps_from_string(
      (std::string("video/x-raw,width=38,height=20,framerate=25/1,format=") + format).c_str());
  GstVideoInfo info;
  gst_video_info_from_caps(&info, caps);
  GstBuffer* depth = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  GstVideoFrame mapped;
  gst_video_frame_map(&mapped, &info, depth, GST_MAP_WRITE);
  for (int y = 0; y < 20; ++y) {
    auto* const row = static_cast<guint8*>(GST_VIDEO_FRAME_PLANE_DATA(&mapped, 0)) +
                      y * GST_VIDEO_FRAME_PLANE_STRIDE(&mapped, 0);
    for (int x = 0; x < 38; ++x) {
      const auto value = static_cast<guint16>(x < 19 ? far_half : near_half);
      if (std::strcmp(format, "GRAY8") == 0) row[x] = static_cast<guint8>(value);
      if (std::strcmp(format, "GRAY16_LE") == 0) GST_WRITE_UINT16_LE(row + 2 * x, value);
      if (std::strcmp(format, "GRAY16_BE") == 0) GST_WRITE_UINT16_BE(row + 2 * x, value);
    }
  }
  gst_video_frame_unmap(&mapped);
  GstBuffer* frame = gst_buffer_new();
  attach_depth_meta(frame, depth, caps, 0, meaning);
  gst_buffer_unref(depth);  // the frame has it
  gst_caps_unref(caps);
  return frame;
}

TEST(FrameDepth, ReadsEveryFormatCorrectly) {
  struct Case {
    const char* format;
    int near_half, far_half;
    DepthMeaning meaning;
  };
  for (const Case& c : {Case{"GRAY8", 200, 20, {true, -1, -1}},
                        {"GRAY8", 200, 20, {true, 200, 20}},
                        {"GRAY16_LE", 700, 2900, {false, -1, -1}},
                        {"GRAY16_BE", 700, 2900, {false, 700, 2900}},
                        {"GRAY16_BE", 700, 2900, {false, 2900, 700}}}) {  // wrong: not set
    GstBuffer* frame = frame_with_depth(c.format, c.near_half, c.far_half, c.meaning);
    DepthPicture picture;
    ASSERT_TRUE(read_frame_depth(frame, 0.04, picture));
    for (int y = 0; y < HeightField::kRows; ++y) {
      const float* const row = picture.levels() + y * HeightField::kColumns;
      // Rounded as in test_depth_picture; the ends of the range are the two samples.
      ASSERT_NEAR(row[20], 0, 1e-6) << c.format;
      ASSERT_NEAR(row[235], 1, 1e-6) << c.format;
    }
    HeightField field(0.06, 0.03375);
    ReliefBuilder builder;
    EXPECT_TRUE(builder.from_levels(picture.levels(), {}, field));
    EXPECT_GT(field.at(0.02, 0).z_m, field.at(-0.02, 0).z_m);
    gst_buffer_unref(frame);
  }
}

TEST(FrameDepth, AFrameWithoutDepthHasNone) {
  GstBuffer* holes = frame_with_depth("GRAY16_LE", 0, 65535, {});
  GstBuffer* bare = gst_buffer_new();
  DepthPicture picture;
  EXPECT_FALSE(read_frame_depth(holes, 0.04, picture));
  EXPECT_FALSE(read_frame_depth(bare, 0.04, picture));
  gst_buffer_unref(holes);
  gst_buffer_unref(bare);
}

}  // namespace
}  // namespace spidar::test::frame_depth_test
