// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Formats that the element does not read in place: packed YUV of cameras, planar RGB, packed words
// of 10 and 12 bits. The measured motion is that of the grey picture.
#include "plugin/frame/frame_luma.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test::unpacked_formats_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr int kWidth = 322, kHeight = 240;  // no multiple of the 6 pixels that v210 packs together

/// The picture of make_frame() in this format, as videoconvert makes it.
GstBuffer* converted(const GstVideoInfo& info, double dx, double dy) {
  GstVideoInfo grey;
  gst_video_info_set_format(&grey, GST_VIDEO_FORMAT_GRAY8, kWidth, kHeight);
  // So that grey levels stay as they are.
  if (GST_VIDEO_INFO_IS_YUV(&info)) grey.colorimetry = info.colorimetry;
  grey.colorimetry.range = info.colorimetry.range;
  grey.fps_n = info.fps_n;
  grey.fps_d = info.fps_d;
  GstBuffer* const source = make_frame(grey, dx, dy);
  GstBuffer* const result = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  GstVideoFrame from, to;
  gst_video_frame_map(&from, &grey, source, GST_MAP_READ);
  gst_video_frame_map(&to, const_cast<GstVideoInfo*>(&info), result, GST_MAP_WRITE);
  GstVideoConverter* const converter = gst_video_converter_new(&grey, &info, nullptr);
  gst_video_converter_frame(converter, &from, &to);
  gst_video_converter_free(converter);
  gst_video_frame_unmap(&to);
  gst_video_frame_unmap(&from);
  gst_buffer_unref(source);
  return result;
}

class UnpackedFormats : public testing::TestWithParam<std::string> {};

TEST_P(UnpackedFormats, MeasureWhatTheGreyPictureShows) {
  ElementHarness h;
  h.set_caps(make_caps(GetParam().c_str(), kWidth, kHeight));
  ElementHarness grey;
  grey.set_caps(make_caps("GRAY8", kWidth, kHeight));
  for (int n = 0; n < 3; ++n) {
    const auto pts = static_cast<GstClockTime>(n) * kFrame;
    GstBuffer* const frame = converted(h.info(), 2.0 * n, -1.0 * n);
    gst_buffer_ref(frame);
    ASSERT_EQ(h.push(frame, pts), GST_FLOW_OK);
    GstBuffer* const out = gst_harness_pull(h.harness());
    EXPECT_EQ(out, frame) << "passed on as it is";
    gst_buffer_unref(out);
    gst_buffer_unref(frame);
    grey.push_moved(2.0 * n, -1.0 * n, pts);
  }
  ASSERT_EQ(h.motions().size(), 3u);
  // Rounded to grey levels once more: a tenth of a pixel, see test_frames.cpp, for each of the two.
  constexpr double kTolerance_px_s = 2 * 0.1 * 25;
  for (size_t n = 1; n < 3; ++n) {
    EXPECT_GT(h.motions()[n].tracked, 20u);
    EXPECT_NEAR(h.motions()[n].velocity_x, grey.motions()[n].velocity_x, kTolerance_px_s);
    EXPECT_NEAR(h.motions()[n].velocity_y, grey.motions()[n].velocity_y, kTolerance_px_s);
  }
  EXPECT_TRUE(h.warnings().empty());
}

TEST_P(UnpackedFormats, HonourACrop) {
  GstVideoInfo info;
  gst_video_info_set_format(&info, gst_video_format_from_string(GetParam().c_str()), kWidth,
                            kHeight);
  GstBuffer* const buffer = converted(info, 0, 0);
  GstVideoFrame frame;
  FrameLuma whole, part;
  gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ);
  const ImageView all = whole.view(frame);
  gst_video_frame_unmap(&frame);
  GstVideoCropMeta* const crop = gst_buffer_add_video_crop_meta(buffer);
  crop->x = 31;
  crop->y = 17;
  crop->width = 100;
  crop->height = 60;
  gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ);
  const ImageView seen = part.view(frame);
  ASSERT_EQ(seen.width, 100);
  ASSERT_EQ(seen.height, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 100; ++x) ASSERT_EQ(*seen.at(x, y), *all.at(x + 31, y + 17));
  }
  gst_video_frame_unmap(&frame);
  gst_buffer_unref(buffer);
}

TEST_P(UnpackedFormats, TooShortFramesAreOnlyPassedOn) {
  ElementHarness h;
  h.set_caps(make_caps(GetParam().c_str(), kWidth, kHeight));
  GstBuffer* const frame = converted(h.info(), 0, 0);
  // The meta promises more than there is: its lines are longer.
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {};
  for (guint p = 0; p < GST_VIDEO_INFO_N_PLANES(&h.info()); ++p) {
    offset[p] = GST_VIDEO_INFO_PLANE_OFFSET(&h.info(), p);
    stride[p] = 2 * GST_VIDEO_INFO_PLANE_STRIDE(&h.info(), p);
  }
  gst_buffer_add_video_meta_full(frame, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_INFO_FORMAT(&h.info()),
                                 kWidth, kHeight, GST_VIDEO_INFO_N_PLANES(&h.info()), offset,
                                 stride);
  EXPECT_EQ(h.push(frame, 0), GST_FLOW_OK);
  EXPECT_TRUE(h.motions().empty());
  EXPECT_EQ(h.warnings().size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, UnpackedFormats,
                         testing::ValuesIn(formats_in(SPIDAR_UNPACKED_FORMATS)),
                         [](const auto& p) { return p.param; });

}  // namespace
}  // namespace spidar::test::unpacked_formats_test
