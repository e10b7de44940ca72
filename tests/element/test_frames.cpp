// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How the element treats frames: formats, strides, crops and fields; frames are not modified.
#include "plugin/filter/motion_state.h"
#include "plugin/frame/frame_luma.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test::frames_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
// Pyramidal Lucas–Kanade on a smooth texture without noise is good to a few hundredths of a pixel a
// point; a tenth is what the mean of many points must keep in any case.
constexpr double kTolerance_px = 0.1;
constexpr double kTolerance_px_s = kTolerance_px * 25;

/// Its bottom field is later: what it shows has moved on by `later_px`.
GstBuffer* make_interlaced(const GstVideoInfo& info, double dx, double later_px) {
  return make_picture(
      info, [&](int x, int y) { return texture(x - dx - (y % 2 == 1 ? later_px : 0), y); });
}

class Formats : public testing::TestWithParam<std::string> {};

TEST_P(Formats, PassThroughUntouchedAndMeasureMotion) {
  ElementHarness h;
  h.set_caps(make_caps(GetParam().c_str(), 323, 241));  // odd: strides differ from widths
  for (int n = 0; n < 3; ++n) {
    GstBuffer* frame = make_frame(h.info(), 2.0 * n, -1.0 * n, 13);
    GstBuffer* untouched = gst_buffer_copy_deep(frame);
    gst_buffer_ref(frame);  // held by somebody else: must neither be copied nor written to
    GstBuffer* out = h.pass(frame, static_cast<GstClockTime>(n) * kFrame);
    EXPECT_EQ(out, frame);
    GstMapInfo a, b;
    gst_buffer_map(out, &a, GST_MAP_READ);
    gst_buffer_map(untouched, &b, GST_MAP_READ);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(memcmp(a.data, b.data, a.size), 0);
    gst_buffer_unmap(out, &a);
    gst_buffer_unmap(untouched, &b);
    gst_buffer_unref(untouched);
    gst_buffer_unref(out);
    gst_buffer_unref(frame);
  }
  ASSERT_EQ(h.motions().size(), 3u);
  EXPECT_EQ(h.motions()[0].tracked, 0u);
  for (size_t n = 1; n < 3; ++n) {
    EXPECT_GT(h.motions()[n].tracked, 20u);
    EXPECT_NEAR(h.motions()[n].velocity_x, 2.0 * 25, kTolerance_px_s);
    EXPECT_NEAR(h.motions()[n].velocity_y, -1.0 * 25, kTolerance_px_s);
  }
  EXPECT_TRUE(h.warnings().empty());
}

INSTANTIATE_TEST_SUITE_P(All, Formats, testing::ValuesIn(video_formats()),
                         [](const auto& p) { return p.param; });

TEST(Frames, SmallestAndOddSizesPass) {
  for (const auto& [width, height] :
       {std::pair{16, 16}, {17, 16}, {16, 31}, {8192, 16}, {16, 8192}}) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    ElementHarness h;
    h.set_caps(make_caps("GRAY8", width, height));
    for (int n = 0; n < 3; ++n) {
      EXPECT_EQ(h.push_moved(n, 0, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    }
    EXPECT_EQ(h.motions().size(), 3u);
    EXPECT_TRUE(h.errors().empty());
  }
}

TEST(Frames, OtherSizesPassAndOneWarningSaysThatTheyAreNotFelt) {
  ElementHarness h;
  GstClockTime pts = 0;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {15, 64}, {64, 15}, {8193, 64}, {64, 8193}}) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    h.set_caps(make_caps("GRAY8", width, height));
    EXPECT_EQ(h.push_moved(0, 0, pts += kFrame), GST_FLOW_OK);
  }
  EXPECT_TRUE(h.motions().empty());
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_EQ(h.warnings()[0], "Frames with a side below 16 or above 8192 pixels are only shown.");
  h.set_caps(make_caps("GRAY8", 320, 240));
  EXPECT_EQ(h.push_moved(0, 0, pts += kFrame), GST_FLOW_OK);
  EXPECT_EQ(h.motions().size(), 1u);
}

/// Resampled to square pixels, 40 × 40 pixels of 1:3 are 13 × 40.
TEST(Frames, SmallOnesWhosePixelsAreNotSquarePass) {
  struct Case {
    int width, height, numerator, denominator;
    bool is_felt;
  };
  for (const Case& c : {Case{40, 40, 1, 3, false},
                        {16, 18, 2, 3, false},
                        {64, 32, 1, 4, true},
                        {16, 16, 3, 1, true},
                        {8192, 16, 4, 1, true}}) {
    SCOPED_TRACE(std::to_string(c.width) + " " + std::to_string(c.numerator));
    ElementHarness h;
    GstCaps* const caps = make_caps("GRAY8", c.width, c.height);
    gst_caps_set_simple(caps, "pixel-aspect-ratio", GST_TYPE_FRACTION, c.numerator, c.denominator,
                        nullptr);
    h.set_caps(caps);
    for (int n = 0; n < 3; ++n) {
      EXPECT_EQ(h.push_moved(n, 0, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    }
    EXPECT_EQ(h.motions().size(), c.is_felt ? 3u : 0u);
    EXPECT_EQ(h.warnings().size(), c.is_felt ? 0u : 1u);
    EXPECT_TRUE(h.errors().empty());
  }
}

TEST(Frames, WhatNobodyForesawIsAWarningForEachStream) {
  ElementHarness h;
  const auto fail = [] { throw std::runtime_error("unforeseen"); };
  filter::BusWarnings& warnings = h.state().warnings;
  EXPECT_FALSE(warnings.guard("testing", fail));
  EXPECT_FALSE(warnings.guard("testing", fail));
  EXPECT_EQ(h.warnings(), std::vector<std::string>{"unforeseen"});
  warnings.begin_stream();
  EXPECT_FALSE(warnings.guard("testing", fail));
  EXPECT_EQ(h.warnings().size(), 2u);
  EXPECT_TRUE(h.errors().empty());
}

TEST(Frames, OnlySystemMemoryIsNegotiated) {
  // So that a decoder which offers DMABuf or GL memory beside it takes the one that can be read.
  ElementHarness h;
  for (const char* memory : {"memory:DMABuf", "memory:GLMemory", "memory:VAMemory"}) {
    SCOPED_TRACE(memory);
    GstCaps* plain = make_caps("NV12", 320, 240);
    GstCaps* elsewhere = gst_caps_copy(plain);
    gst_caps_set_features(elsewhere, 0, gst_caps_features_new(memory, nullptr));
    GstPad* pad = GST_PAD_PEER(h.harness()->srcpad);
    EXPECT_FALSE(gst_pad_query_accept_caps(pad, elsewhere));
    GstCaps* offered = gst_caps_merge(elsewhere, gst_caps_ref(plain));
    GstCaps* possible = gst_pad_query_caps(pad, offered);
    EXPECT_TRUE(gst_caps_is_equal(possible, plain));
    gst_caps_unref(possible);
    gst_caps_unref(offered);
    gst_caps_unref(plain);
  }
}

TEST(Frames, CapsMayChangeWhilePlaying) {
  ElementHarness h;
  h.set_caps(make_caps("GRAY8", 320, 240));
  h.push_moved(0, 0, 0);
  h.push_moved(2, 0, kFrame);
  h.set_caps(make_caps("I420", 640, 360));
  h.push_moved(0, 0, 2 * kFrame);
  h.push_moved(4, 0, 3 * kFrame);
  ASSERT_EQ(h.motions().size(), 4u);
  EXPECT_NEAR(h.motions()[1].velocity_x, 50, kTolerance_px_s);
  // Nothing to compare the first frame of the new size with: exactly no motion.
  EXPECT_EQ(h.motions()[2].velocity_x, 0);
  EXPECT_EQ(h.motions()[2].tracked, 0u);
  EXPECT_NEAR(h.motions()[3].velocity_x, 100, kTolerance_px_s);
}

TEST(Frames, CropsThatLeaveNothingOrReachOutsideAreHarmless) {
  ElementHarness h;
  h.set_caps(make_caps("GRAY8", 320, 240));
  GstClockTime pts = 0;
  for (const auto& [x, y, width, height] : {std::array<guint, 4>{0, 0, 0, 0},
                                            {400, 300, 10, 10},
                                            {300, 200, 4000, 4000},
                                            {0, 0, 3, 3}}) {
    GstBuffer* frame = make_frame(h.info(), 0, 0);
    GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(frame);
    crop->x = x;
    crop->y = y;
    crop->width = width;
    crop->height = height;
    EXPECT_EQ(h.push(frame, pts += kFrame), GST_FLOW_OK);
  }
  EXPECT_TRUE(h.errors().empty());
}

TEST(Frames, InterlacedFramesAreMeasuredByOneField) {
  // The bottom field is half a frame later: as whole frames the two would contradict each other.
  ElementHarness h;
  GstCaps* caps = make_caps("GRAY8", 640, 480);
  gst_caps_set_simple(caps, "interlace-mode", G_TYPE_STRING, "interleaved", "field-order",
                      G_TYPE_STRING, "top-field-first", nullptr);
  h.set_caps(caps);
  for (int n = 0; n < 2; ++n) {
    GstBuffer* frame = make_interlaced(h.info(), 4.0 * n, 2);
    GST_BUFFER_FLAG_SET(frame, GST_VIDEO_BUFFER_FLAG_INTERLACED | GST_VIDEO_BUFFER_FLAG_TFF);
    ASSERT_EQ(h.push(frame, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
  }
  ASSERT_EQ(h.motions().size(), 2u);
  EXPECT_NEAR(h.motions()[1].velocity_x, 100, kTolerance_px_s);
  EXPECT_NEAR(h.motions()[1].velocity_y, 0, kTolerance_px_s);
}

/// The luma that is analysed of a frame in which `flagged` says that its fields are two moments.
std::vector<uint8_t> analysed_luma(GstBuffer* frame, bool flagged) {
  GstVideoInfo info;
  gst_video_info_set_interlaced_format(
      &info, GST_VIDEO_FORMAT_GRAY8,
      flagged ? GST_VIDEO_INTERLACE_MODE_INTERLEAVED : GST_VIDEO_INTERLACE_MODE_PROGRESSIVE, 640,
      480);
  GST_VIDEO_INFO_FIELD_ORDER(&info) = GST_VIDEO_FIELD_ORDER_TOP_FIELD_FIRST;
  GstVideoFrame mapped;
  EXPECT_TRUE(gst_video_frame_map(&mapped, &info, frame, GST_MAP_READ));
  FrameLuma luma;
  const ImageView view = luma.view(mapped);
  std::vector<uint8_t> pixels;
  for (int y = 0; y < view.height; ++y) pixels.insert(pixels.end(), view.at(0, y), view.at(640, y));
  gst_video_frame_unmap(&mapped);
  return pixels;
}

TEST(Frames, FieldsThatAreNotFlaggedAreReadAsThoseThatAre) {
  for (const double step_px : {0.0, 5.0}) {
    ElementHarness h;
    h.set_caps(make_caps("GRAY8", 640, 480));
    GstBuffer* frame = make_interlaced(h.info(), 0, step_px);
    const std::vector<uint8_t> whole = analysed_luma(frame, false);
    const std::vector<uint8_t> field = analysed_luma(frame, true);
    EXPECT_EQ(whole == field, step_px > 0) << "fields apart by " << step_px << " px";
    gst_buffer_unref(frame);
  }
}

TEST(Frames, OfMixedStreamsThoseThatAreFlaggedAreMeasuredByOneField) {
  // Telecined films have both. The second field of a flagged frame shows another moment.
  ElementHarness h;
  GstCaps* caps = make_caps("GRAY8", 640, 480);
  gst_caps_set_simple(caps, "interlace-mode", G_TYPE_STRING, "mixed", nullptr);
  h.set_caps(caps);
  const std::array<bool, 6> interlaced{false, false, true, true, false, false};
  for (size_t n = 0; n < interlaced.size(); ++n) {
    GstBuffer* frame =
        make_interlaced(h.info(), 4.0 * static_cast<double>(n), interlaced[n] ? 2 : 0);
    if (interlaced[n]) {
      GST_BUFFER_FLAG_SET(frame, GST_VIDEO_BUFFER_FLAG_INTERLACED | GST_VIDEO_BUFFER_FLAG_TFF);
    }
    ASSERT_EQ(h.push(frame, n * kFrame), GST_FLOW_OK);
  }
  ASSERT_EQ(h.motions().size(), interlaced.size());
  for (size_t n = 1; n < interlaced.size(); ++n) {
    EXPECT_NEAR(h.motions()[n].velocity_x, 100, kTolerance_px_s) << n;
    EXPECT_NEAR(h.motions()[n].velocity_y, 0, kTolerance_px_s) << n;
  }
}

}  // namespace
}  // namespace spidar::test::frames_test
