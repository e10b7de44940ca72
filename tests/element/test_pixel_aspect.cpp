// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The same film, stored with pixels that are not square, feels the same.
#include "core/force/gain_controller.h"
#include "core/force/motion_rendering.h"
#include "plugin/frame/frame_luma.h"
#include "plugin/frame/object_metas.h"
#include "tests/support/canvas.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"
#include "tests/support/video_frames.h"

namespace spidar::test::pixel_aspect_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr double kFrames_s = 25;
/// As it is shown.
constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr double kDisc_px = 80;

/// Grey level of frame n at a position of the shown picture, px from its middle.
using Film = std::function<double(int n, double x_px, double y_px)>;

double wall(double x_px, double y_px) {
  static const Texture texture(1, 12);
  return texture.at(x_px, y_px);
}

double paper(double x_px, double y_px) {
  static const Texture texture(3, 12);
  return texture.at(x_px, y_px);
}

/// A camera that pans to the lower right.
double pan(int n, double x_px, double y_px) {
  return wall(x_px + 5.0 * n, y_px + 3.0 * n);
}

/// A disc that moves to the upper right.
double moving_disc(int n, double x_px, double y_px) {
  const double on_x_px = x_px - 4.0 * n + 30, on_y_px = y_px + 4.0 * n - 30;
  return std::hypot(on_x_px, on_y_px) < kDisc_px ? paper(on_x_px, on_y_px) : wall(x_px, y_px);
}

/// A camera that turns by a degree a frame, and comes nearer by 1 %.
double turn_and_grow(int n, double x_px, double y_px) {
  const double angle = n * M_PI / 180, size = std::pow(1.01, n);
  const double c = std::cos(angle) / size, s = std::sin(angle) / size;
  return wall(c * x_px + s * y_px, c * y_px - s * x_px);
}

struct Aspect {
  int n, d;
  /// Of the frame as it is stored.
  int width() const { return kWidth * d / n; }
};

GstBuffer* frame_of(const Film& film, int n, const GstVideoInfo& info) {
  const double pixel_px = static_cast<double>(kWidth) / GST_VIDEO_INFO_WIDTH(&info);
  return make_picture(info, [&](int x, int y) {
    return film(n, (x + 0.5) * pixel_px - kWidth / 2.0, y + 0.5 - kHeight / 2.0);
  });
}

GstCaps* caps_of(const Aspect& aspect) {
  GstCaps* caps = make_caps("GRAY8", aspect.width(), kHeight);
  gst_caps_set_simple(caps, "pixel-aspect-ratio", GST_TYPE_FRACTION, aspect.n, aspect.d, nullptr);
  return caps;
}

/// What is said of ten frames, and the objects on the last one.
struct Felt {
  std::vector<MotionMessage> frames;
  std::vector<ObjectBox> boxes;
};

Felt feel(const Film& film, const std::string& properties, const Aspect& aspect) {
  ElementHarness h("device=none attach-meta=true filter-min-cutoff=0 " + properties);
  h.set_caps(caps_of(aspect));
  Felt felt;
  for (int n = 0; n < 10; ++n) {
    GstBuffer* out = h.pass(frame_of(film, n, h.info()), static_cast<GstClockTime>(n) * kFrame);
    felt.boxes = read_object_metas(out);
    gst_buffer_unref(out);
  }
  felt.frames = h.motions();
  return felt;
}

// As in test_frames: each of two measurements is right to a tenth of a pixel of the shown picture.
constexpr double kTolerance_px_s = 2 * 0.1 * kFrames_s;

/// By which forces may differ whose speeds differ by so much: the arctangent is steepest at rest.
double force_of(double speed_px_s) {
  const ControllerSettings settings;
  return settings.max_force_N * M_2_PI * settings.alpha_s_px * speed_px_s * kReferenceHeight_px /
         kHeight;
}

constexpr Aspect kSquare{1, 1};
constexpr Aspect kAspects[] = {{64, 45}, {4, 3}, {8, 9}, {2, 1}, {1, 2}};

TEST(PixelAspect, APanAndAnObjectFeelAsInSquarePixels) {
  // A box ends with blocks of some 16 shown pixels.
  constexpr double kBlock_px = 2 * 16;
  struct Case {
    const char* properties;
    Film film;
  };
  const Case cases[] = {{"motion=mean", pan},
                        {"motion=camera", pan},
                        {"motion=object", moving_disc},
                        {"motion=objects pointer=0.4,0.6", moving_disc},
                        {"motion=object feel=\"0:00- object at 0.48,0.55\"", moving_disc}};
  for (const Case& c : cases) {
    const Felt square = feel(c.film, c.properties, kSquare);
    if (std::string(c.properties) == "motion=object") {
      ASSERT_EQ(square.boxes.size(), 1u);
    }
    for (const Aspect& aspect : kAspects) {
      SCOPED_TRACE(std::string(c.properties) + " " + std::to_string(aspect.n) + "/" +
                   std::to_string(aspect.d));
      const Felt felt = feel(c.film, c.properties, aspect);
      ASSERT_EQ(felt.frames.size(), square.frames.size());
      const double pixel_px = static_cast<double>(aspect.n) / aspect.d;
      ASSERT_EQ(felt.boxes.size(), square.boxes.size());
      for (size_t n = 0; n < felt.boxes.size(); ++n) {
        const ObjectBox &a = felt.boxes[n], &b = square.boxes[n];
        EXPECT_NEAR(a.x * pixel_px, b.x, kBlock_px);
        EXPECT_NEAR(a.width * pixel_px, b.width, kBlock_px);
        EXPECT_NEAR(a.y, b.y, kBlock_px);
        EXPECT_NEAR(a.height, b.height, kBlock_px);
      }
      // An object is known from the second pair of frames on, and fades in.
      for (size_t n = 6; n < felt.frames.size(); ++n) {
        const MotionMessage &a = felt.frames[n], &b = square.frames[n];
        ASSERT_GT(b.wrench.force_N.norm(), 0.5) << n;
        EXPECT_LT((a.wrench.force_N - b.wrench.force_N).norm(), force_of(kTolerance_px_s)) << n;
        EXPECT_NEAR(a.velocity_x * pixel_px, b.velocity_x, kTolerance_px_s) << n;
        EXPECT_NEAR(a.velocity_y, b.velocity_y, kTolerance_px_s) << n;
      }
    }
  }
}

TEST(PixelAspect, GrowthAndRollFeelAsInSquarePixels) {
  // They count as the speed at half a frame's height from the middle, where a displacement is right
  // to the same part of a pixel as elsewhere.
  const Felt square = feel(turn_and_grow, "motion=camera", kSquare);
  for (const Aspect& aspect : kAspects) {
    SCOPED_TRACE(std::to_string(aspect.n) + "/" + std::to_string(aspect.d));
    const Felt felt = feel(turn_and_grow, "motion=camera", aspect);
    ASSERT_EQ(felt.frames.size(), square.frames.size());
    for (size_t n = 2; n < felt.frames.size(); ++n) {
      const Wrench &a = felt.frames[n].wrench, &b = square.frames[n].wrench;
      const double a_roll_N = a.torque_Nm.z() / kTorqueArm_m;
      const double b_roll_N = b.torque_Nm.z() / kTorqueArm_m;
      EXPECT_GT(std::abs(b.force_N.z()), 0.2) << n;
      EXPECT_GT(std::abs(b_roll_N), 0.2) << n;
      EXPECT_NEAR(a.force_N.z(), b.force_N.z(), force_of(kTolerance_px_s)) << n;
      EXPECT_NEAR(a_roll_N, b_roll_N, force_of(kTolerance_px_s)) << n;
    }
  }
}

TEST(PixelAspect, AHeaderThatCannotBeRightIsIgnored) {
  GstVideoInfo info;
  gst_video_info_set_format(&info, GST_VIDEO_FORMAT_I420, 720, 576);
  struct Case {
    int n, d;
    double aspect;
  };
  for (const Case& c : {Case{64, 45, 64.0 / 45}, {1, 1, 1}, {4, 1, 4}, {5, 1, 1}, {1, 1000, 1}}) {
    GST_VIDEO_INFO_PAR_N(&info) = c.n;
    GST_VIDEO_INFO_PAR_D(&info) = c.d;
    EXPECT_EQ(pixel_aspect(info), c.aspect) << c.n << "/" << c.d;
  }
}

/// Two views in one frame, of which only the first moves.
GstBuffer* two_views(const GstVideoInfo& info, int n, bool beside) {
  return make_picture(info, [&](int x, int y) {
    const bool is_first = beside ? x < kWidth / 2 : y < kHeight / 2;
    // Halved along the side on which they are packed.
    const double shown_x = beside ? 2 * x : x, shown_y = beside ? y : 2 * y;
    return is_first ? wall(shown_x + 6.0 * n, shown_y + 6.0 * n) : wall(shown_x, shown_y);
  });
}

/// That they were squeezed is said, or shows in the shape of the frame, which is that of one.
TEST(PixelAspect, OfTwoViewsInAFrameTheFirstIsFelt) {
  for (const auto& [beside, is_said] :
       {std::pair(true, true), {false, true}, {true, false}, {false, false}}) {
    SCOPED_TRACE(is_said);
    ElementHarness h("device=none motion=mean");
    GstCaps* caps = make_caps("GRAY8", kWidth, kHeight);
    const auto flags =
        is_said ? GST_VIDEO_MULTIVIEW_FLAGS_HALF_ASPECT : GST_VIDEO_MULTIVIEW_FLAGS_NONE;
    gst_caps_set_simple(caps, "multiview-mode", G_TYPE_STRING,
                        beside ? "side-by-side" : "top-bottom", "multiview-flags",
                        GST_TYPE_VIDEO_MULTIVIEW_FLAGSET, flags, GST_FLAG_SET_MASK_EXACT, nullptr);
    h.set_caps(caps);
    for (int n = 0; n < 3; ++n) {
      ASSERT_EQ(h.push(two_views(h.info(), n, beside), static_cast<GstClockTime>(n) * kFrame),
                GST_FLOW_OK);
    }
    ASSERT_EQ(h.motions().size(), 3u);
    // Of a picture twice as wide or high, to the upper left by the same in both directions.
    const Eigen::Vector3d force_N = h.motions()[2].wrench.force_N;
    EXPECT_LT(force_N.x(), -0.5) << beside;
    EXPECT_NEAR(force_N.x(), -force_N.y(), force_of(2 * kTolerance_px_s)) << beside;
  }
}

TEST(PixelAspect, WhatIsDrawnIsRoundAsItIsShown) {
  // A ring for the finger of 11 px (see test_overlay), in pixels twice as wide as high.
  Canvas canvas("RGB", 320, 480);
  canvas.set_pixel_aspect(2, 1);
  DrawnFrame touched;
  touched.touch_mark.emplace().finger = {0.5, 0.5};
  canvas.draw(touched);
  int across = 0, down = 0;
  for (int x = 0; x < 320; ++x) across += canvas.is_drawn(x, 239);
  for (int y = 0; y < 480; ++y) down += canvas.is_drawn(159, y);
  EXPECT_GT(down, 8);
  EXPECT_NEAR(2 * across, down, 4) << "each end may be off by a wide pixel";

  // The force to the upper right points there as it is shown.
  Canvas arrow("RGB", 320, 480);
  arrow.set_pixel_aspect(2, 1);
  DrawnFrame report;
  report.frame.wrench.force_N = {2, 2, 0};
  arrow.draw(report);
  EXPECT_EQ(arrow.at(160 + 15, 240 - 30), (Pixel{255, 255, 255}));
  EXPECT_FALSE(arrow.is_drawn(160 + 30, 240 - 30));
}

TEST(PixelAspect, BlackAndWhiteAreThoseOfTheCaps) {
  const auto levels = [](const char* format, const char* colorimetry) {
    GstCaps* caps = make_caps(format, 640, 480);
    if (colorimetry) {
      gst_caps_set_simple(caps, "colorimetry", G_TYPE_STRING, colorimetry, nullptr);
    }
    GstVideoInfo info;
    EXPECT_TRUE(gst_video_info_from_caps(&info, caps)) << format;
    gst_caps_unref(caps);
    const LumaLevels found = luma_levels(info);
    return std::pair(found.black, found.white);
  };
  EXPECT_EQ(levels("I420", nullptr), std::pair(16, 235));
  EXPECT_EQ(levels("I420_10LE", nullptr), std::pair(16, 235));
  EXPECT_EQ(levels("I420", "1:4:0:0"), std::pair(0, 255)) << "as in JPEG";
  EXPECT_EQ(levels("RGB", nullptr), std::pair(0, 255));
  EXPECT_EQ(levels("YUY2", nullptr), std::pair(16, 235));
}

}  // namespace
}  // namespace spidar::test::pixel_aspect_test
