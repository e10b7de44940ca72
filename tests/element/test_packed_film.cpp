// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The motion of a film in 2D+Z is that of the half that is picture.
#include <tuple>

#include <gst-spidar/gstspidarmotionmeta.h>

#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::packed_film_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr int kWidth = 640, kHeight = 480;
constexpr double kPicture_px = 2;  // to the right, from frame to frame
constexpr double kDepth_px = -3;
// As in test_frames.cpp: a tenth of a pixel is what the mean of many points must keep.
constexpr double kTolerance_px = 0.1;

struct Played {
  double velocity_x = 0;
  GstSpidarFrameMotion motion{};
  std::vector<GstSpidarMotionPoint> points;
};

/// Frames whose first half moves by kPicture_px and whose second one, to the right or below, by
/// kDepth_px. What was found in the last.
Played play(const std::string& properties, bool right) {
  ElementHarness h("device=none attach-meta=true " + properties);
  h.set_caps(make_caps("GRAY8", kWidth, kHeight));
  Played played;
  for (int n = 0; n < 3; ++n) {
    GstBuffer* frame = make_picture(h.info(), [&](int x, int y) {
      const bool is_picture = right ? x < kWidth / 2 : y < kHeight / 2;
      return texture(x - (is_picture ? kPicture_px : kDepth_px) * n, y);
    });
    GstBuffer* out = h.pass(frame, static_cast<GstClockTime>(n) * kFrame);
    if (n == 2) {
      EXPECT_TRUE(gst_buffer_get_spidar_motion(out, &played.motion));
      GArray* points = gst_buffer_get_spidar_points(out);
      for (guint i = 0; points != nullptr && i < points->len; ++i) {
        played.points.push_back(g_array_index(points, GstSpidarMotionPoint, i));
      }
      g_clear_pointer(&points, g_array_unref);
    }
    gst_buffer_unref(out);
  }
  EXPECT_EQ(h.motions().size(), 3u);
  if (h.motions().size() == 3) played.velocity_x = h.motions()[2].velocity_x;
  return played;
}

TEST(PackedFilm, MotionIsThatOfThePictureAndPlacesAreThoseOfTheFrame) {
  for (const bool right : {true, false}) {
    const Played played = play(right ? "touch=depth" : "touch=depth-below", right);
    EXPECT_NEAR(played.velocity_x, 25 * kPicture_px, 25 * kTolerance_px);
    EXPECT_EQ(played.motion.width, static_cast<guint>(kWidth));
    EXPECT_EQ(played.motion.height, static_cast<guint>(kHeight));
    EXPECT_GT(played.points.size(), 20u);
    double least_x = kWidth, most_x = 0;
    for (const GstSpidarMotionPoint& point : played.points) {
      EXPECT_NEAR(point.to_x - point.from_x, kPicture_px, 0.5);
      EXPECT_LT(point.to_x, right ? kWidth / 2 : kWidth);
      EXPECT_LT(point.to_y, right ? kHeight : kHeight / 2);
      least_x = std::min(least_x, point.to_x);
      most_x = std::max(most_x, point.to_x);
    }
    // Points are found all over the half, in pixels of the frame.
    const double width = right ? kWidth / 2 : kWidth;
    EXPECT_LT(least_x, 0.2 * width);
    EXPECT_GT(most_x, 0.8 * width);
  }
}

TEST(PackedFilm, WithoutTouchingDepthTheWholeFrameIsThePicture) {
  for (const char* properties : {"touch=off", "touch=luma"}) {
    const Played played = play(properties, true);
    int in_depth = 0;
    for (const GstSpidarMotionPoint& point : played.points) in_depth += point.to_x > kWidth / 2;
    EXPECT_GT(in_depth, 10) << properties;
  }
}

TEST(PackedFilm, AHalfThatIsTooSmallIsNotAnalysedAndWarnedAboutOnce) {
  for (const auto& [touch, width, height] :
       {std::tuple{"depth", 30, 240}, std::tuple{"depth-below", 240, 30}}) {
    SCOPED_TRACE(touch);
    ElementHarness h(std::string("device=none touch=") + touch);
    h.set_caps(make_caps("GRAY8", width, height));
    for (int n = 0; n < 3; ++n) h.push_moved(n, 0, static_cast<GstClockTime>(n) * kFrame);
    EXPECT_EQ(gst_harness_buffers_received(h.harness()), 3u);
    EXPECT_TRUE(h.motions().empty());
    EXPECT_TRUE(h.errors().empty());
    ASSERT_EQ(h.warnings().size(), 1u);
    EXPECT_NE(h.warnings()[0].find("half"), std::string::npos);
  }
}

}  // namespace
}  // namespace spidar::test::packed_film_test
