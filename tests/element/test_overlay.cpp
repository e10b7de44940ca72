// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The overlay in the video, read back from the pixels.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/filter/overlay/stroke_text.h"
#include "tests/support/canvas.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test::overlay_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
SceneView one_track(ImagePoint from, ImagePoint to, TrackOwner owner = TrackOwner::kUnknown) {
  SceneView scene;
  scene.tracks.push_back({1, from, to, owner, 0, false});
  return scene;
}

/// Red, in each format's own numbers: BT.601, YUV in the limited range and grey in the full one, as
/// caps of this size have it.
Pixel red(const std::string& name) {
  const GstVideoFormatInfo* format = gst_video_format_get_info(format_named(name));
  if (GST_VIDEO_FORMAT_INFO_IS_RGB(format)) return {255, 0, 0};
  const guint depth = GST_VIDEO_FORMAT_INFO_DEPTH(format, 0);
  const auto of = [](double value) { return static_cast<int>(std::lround(value)); };
  if (GST_VIDEO_FORMAT_INFO_IS_GRAY(format)) return {of(0.299 * ((1 << depth) - 1)), 0, 0};
  const int one = 1 << (depth - 8);  // a step of 8 bits
  return {of(one * (16 + 219 * 0.299)), of(one * (128 - 224 * 0.299 / (2 * 0.886))),
          of(one * (128 + 224 / 2.0))};
}

class OverlayFormats : public testing::TestWithParam<std::string> {};

TEST_P(OverlayFormats, AnArrowHasTailHeadAndColourWhereTheyMustBe) {
  for (const auto& [width, height] : {std::pair{64, 48}, {65, 49}, {67, 33}}) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    Canvas canvas(GetParam().c_str(), width, height);
    canvas.draw(one_track({10, 20}, {16, 20}), 4);
    EXPECT_EQ(canvas.at(10, 20), red(GetParam())) << "tail";
    EXPECT_EQ(canvas.at(22, 20), red(GetParam())) << "shaft";
    EXPECT_EQ(canvas.at(34, 20), red(GetParam())) << "tip: four times the displacement";
    // The head is max(min(12, 4 · 1.5) / 2, 1.5) = 3 px to either side where it begins, 6 px before
    // the tip; the shaft is less than one.
    EXPECT_EQ(canvas.at(29, 18), red(GetParam()));
    EXPECT_EQ(canvas.at(29, 22), red(GetParam()));
    for (const auto& [x, y] :
         {std::pair{7, 20}, {37, 20}, {22, 17}, {22, 24}, {29, 15}, {29, 26}}) {
      EXPECT_EQ(canvas.at(x, y), canvas.untouched()) << x << "," << y;
    }
    EXPECT_TRUE(canvas.guards_hold());
  }
}

TEST_P(OverlayFormats, WhatIsOutsideTheFrameIsClipped) {
  const float far = 1e9F;
  Canvas canvas(GetParam().c_str(), 33, 17);
  for (const auto& [from, to] : {std::pair<ImagePoint, ImagePoint>{{-5, 3}, {40, 3}},
                                 {{3, -9}, {3, 30}},
                                 {{30, 16}, {50, 40}},
                                 {{0, 0}, {-7, -7}},
                                 {{-far, 8}, {far, 8}},
                                 {{8, far}, {8, far}},
                                 {{32, 16}, {32, 16}}}) {
    canvas.draw(one_track(from, to));
  }
  const float none = std::numeric_limits<float>::quiet_NaN();
  canvas.draw(one_track({none, 1}, {2, 2}));
  EXPECT_TRUE(canvas.guards_hold());
  EXPECT_NE(canvas.at(0, 3), canvas.untouched());
  EXPECT_NE(canvas.at(3, 12), canvas.untouched());
  EXPECT_NE(canvas.at(32, 16), canvas.untouched()) << "the last pixel of an odd frame";
}

INSTANTIATE_TEST_SUITE_P(All, OverlayFormats, testing::ValuesIn(video_formats()),
                         [](const auto& p) { return p.param; });

TEST(Overlay, FollowsTheColorimetryOfTheFrame) {
  Canvas canvas("I420", 64, 48, "bt709");
  canvas.draw(one_track({10, 20}, {34, 20}));
  // Y = 16 + 219 · 0.2126, U = 128 − 224 · 0.2126 / (2 · 0.9278), V = 240.
  EXPECT_EQ(canvas.at(20, 20), (Pixel{63, 102, 240}));
}

TEST(Overlay, TracksAreDrawnOnlyWhenAskedFor) {
  SceneView scene = one_track({10, 20}, {34, 20});
  scene.lost.push_back({50, 10});
  MovingObject object;
  object.tracks = 5;
  object.size_px = {20, 10};
  scene.objects.push_back(object);
  Canvas canvas("RGB", 64, 48);
  canvas.with_frame([&](GstVideoFrame& frame) {
    draw_overlay(scene, false, {}, visible_part(frame), 1, 3, std::nullopt, frame);
  });
  EXPECT_EQ(canvas.at(20, 20), canvas.untouched());
  EXPECT_EQ(canvas.at(50, 10), canvas.untouched());
  EXPECT_NE(canvas.at(32, 19), canvas.untouched()) << "the upper side of the object's box";
}

TEST(Overlay, ColoursSayTheDirectionAndTheOwner) {
  const auto expect = [](Rgb got, int r, int g, int b) {
    EXPECT_TRUE(got ==
                (Rgb{static_cast<uint8_t>(r), static_cast<uint8_t>(g), static_cast<uint8_t>(b)}))
        << int{got.r} << " " << int{got.g} << " " << int{got.b};
  };
  expect(direction_color({1, 0}, 1), 255, 0, 0);
  expect(direction_color({0, -1}, 1), 128, 255, 0);  // up: 90 degrees, half way yellow to green
  expect(direction_color({-1, 0}, 1), 0, 255, 255);
  expect(direction_color({0, 1}, 1), 128, 0, 255);
  expect(direction_color({1, 0}, 0), 255, 255, 255);

  Canvas background("RGB", 640, 480), object("RGB", 640, 480);
  background.draw(one_track({100, 99}, {200, 99}, TrackOwner::kBackground));
  object.draw(one_track({100, 99}, {200, 99}, TrackOwner::kObject));
  EXPECT_EQ(object.at(150, 99), (Pixel{255, 0, 0}));
  EXPECT_EQ(background.at(150, 99), (Pixel{255, 140, 140}));  // 255 (1 − 0.45)
  // 2.5 px against 1.5 px wide.
  EXPECT_EQ(object.at(150, 100), (Pixel{255, 0, 0}));
  EXPECT_EQ(background.at(150, 100), background.untouched());
}

TEST(Overlay, TheFeltForceIsOneBoldArrowFromTheMiddle) {
  Canvas canvas("RGB", 641, 481);
  SceneView scene;
  scene.wrench.force_N = {0, 3, 0};  // up, the most there is
  canvas.draw(scene);
  // Tail at (320, 240), a fifth of 481 lines long.
  EXPECT_EQ(canvas.at(320, 239), (Pixel{255, 255, 255}));
  EXPECT_EQ(canvas.at(320, 240 - 94), (Pixel{255, 255, 255}));
  EXPECT_EQ(canvas.at(316, 200), (Pixel{0, 0, 0})) << "its border";
  EXPECT_EQ(canvas.at(320, 260), canvas.untouched());
  EXPECT_EQ(canvas.at(320, 240 - 105), canvas.untouched());

  Canvas still("RGB", 641, 481);
  still.draw(SceneView());
  EXPECT_EQ(still.at(320, 240), still.untouched());
  Canvas off("RGB", 641, 481);
  off.draw(scene, 1, 0);  // max-force 0
  EXPECT_EQ(off.at(320, 240), off.untouched());
}

TEST(Overlay, AnObjectHasItsBoxAndTheFeltOneAThickOneFromWhichTheArrowBegins) {
  Canvas canvas("RGB", 641, 481);
  SceneView scene;
  scene.objects.resize(3);
  for (uint32_t i = 0; i < 3; ++i) {
    MovingObject& object = scene.objects[i];
    object.id = i + 1;
    object.tracks = i == 2 ? 0 : 5;  // the last one is out of sight
    object.position_px = {-200 + 200.0 * i, 60};
    object.size_px = {80, 40};
  }
  scene.wrench.force_N = {3, 0, 0};
  canvas.draw(scene, 1, 3, std::nullopt, {1});
  const Pixel white{255, 255, 255}, orange{255, 160, 30}, black{0, 0, 0};
  // The boxes are around (120, 300), (320, 300) and (520, 300).
  EXPECT_EQ(canvas.at(80, 310), orange);
  EXPECT_EQ(canvas.at(82, 310), black) << "2 px wide, in 4 px of black";
  EXPECT_EQ(canvas.at(280, 316), white);
  EXPECT_EQ(canvas.at(282, 316), canvas.untouched());
  EXPECT_EQ(canvas.at(480, 310), canvas.untouched());
  // A fifth of 481 lines to the right, from the middle of the felt one.
  EXPECT_EQ(canvas.at(121, 300), white);
  EXPECT_EQ(canvas.at(120 + 94, 300), white);
  EXPECT_EQ(canvas.at(320, 240), canvas.untouched()) << "nothing in the middle of the picture";
}

TEST(Overlay, NewtonsStandBeyondTheTipOfTheArrowUprightAsItIsShown) {
  for (const bool turned : {false, true}) {
    SCOPED_TRACE(turned);
    Canvas canvas("RGB", 641, 481);
    SceneView scene;
    if (turned) scene.turn = PictureTurn(2);
    scene.wrench.force_N = {1, 0, 0};  // "1.0 N"
    canvas.draw(scene);
    // In heights of 16.8 px: 1, point, 0, space and N are 0.55, 0.1, 0.55, 0.1 and 0.55 wide, with
    // 0.25 between them. The tip is 481 / 5 / 3 = 32 px from the middle; two widths of it and
    // 2 · 2.4 px remain free.
    const double height_px = 0.035 * 481, left_px = 320 + 32.1 + 12 + 4.8,
                 top_px = 240 - height_px / 2;
    const auto at = [&](double x, double y) {
      const double x_px = left_px + height_px * x, y_px = top_px + height_px * y;
      const auto of = [&](double px, int last) {
        return static_cast<int>(std::lround(turned ? last - px : px));
      };
      return canvas.at(of(x_px, 640), of(y_px, 480));
    };
    const Pixel white{255, 255, 255};
    EXPECT_EQ(at(0.55, 0.25), white) << "the right bar of the 1";
    EXPECT_NE(at(0, 0.25), white) << "it has no left one";
    EXPECT_EQ(at(1.15, 0.25), white) << "the left bar of the 0";
    EXPECT_NE(at(1.15 + 0.275, 0.5), white) << "it has no middle one";
    EXPECT_EQ(at(2.3 + 0.275, 0.5), white) << "the middle of the N";
    EXPECT_NE(at(2.3 + 0.45, 0.2), white) << "beside it";
  }
}

TEST(Overlay, NumbersHaveTheBarsOfSevenSegments) {
  const int bars[] = {6, 2, 5, 5, 4, 5, 6, 3, 7, 6};
  for (int digit = 0; digit < 10; ++digit) {
    EXPECT_EQ(strokes_of(std::to_string(digit)).size(), static_cast<size_t>(bars[digit])) << digit;
  }
  EXPECT_DOUBLE_EQ(stroke_width_of("1.0 N"), 3 * 0.55 + 2 * 0.1 + 4 * 0.25);
  EXPECT_EQ(stroke_width_of(""), 0);
}

/// Bytes of `a` that differ in `b`.
size_t differences(GstBuffer* a, GstBuffer* b) {
  GstMapInfo x, y;
  gst_buffer_map(a, &x, GST_MAP_READ);
  gst_buffer_map(b, &y, GST_MAP_READ);
  size_t count = x.size == y.size ? 0 : x.size;
  for (gsize i = 0; i < x.size && i < y.size; ++i) count += x.data[i] != y.data[i];
  gst_buffer_unmap(a, &x);
  gst_buffer_unmap(b, &y);
  return count;
}

TEST(OverlayElement, WritesToNoFrameThatSomebodyElseHolds) {
  ElementHarness h("device=none overlay=tracks");
  h.set_caps(make_caps("I420", 323, 241));
  for (int n = 0; n < 3; ++n) {
    GstBuffer* frame = make_frame(h.info(), 3.0 * n, 0, 13);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    ASSERT_EQ(h.push(gst_buffer_ref(frame), static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    GstBuffer* out = gst_harness_pull(h.harness());
    EXPECT_NE(out, frame);
    EXPECT_EQ(differences(frame, before), 0u);
    // Nothing is known of the first one; later on some twenty points and more move by 3 px: arrows
    // of 12 px by 1.5 px and more.
    GstVideoFrame drawn, plain;
    gst_video_frame_map(&drawn, &h.info(), out, GST_MAP_READ);
    gst_video_frame_map(&plain, &h.info(), before, GST_MAP_READ);
    int red_pixels = 0;
    for (int y = 0; y < 241; ++y) {
      for (int x = 0; x < 323; ++x) {
        const auto v = [&](const GstVideoFrame& f) {
          return static_cast<const guint8*>(
              GST_VIDEO_FRAME_COMP_DATA(&f, 2))[y / 2 * GST_VIDEO_FRAME_COMP_STRIDE(&f, 2) + x / 2];
        };
        red_pixels += v(drawn) > 200 && v(plain) == 128;
      }
    }
    if (n == 0) {
      EXPECT_EQ(red_pixels, 0);
    } else {
      EXPECT_GT(red_pixels, 20 * 12);
    }
    gst_video_frame_unmap(&drawn);
    gst_video_frame_unmap(&plain);
    gst_buffer_unref(before);
    gst_buffer_unref(out);
    gst_buffer_unref(frame);
  }
  // What is drawn is not measured again.
  EXPECT_NEAR(h.motions()[2].velocity_x, 75, 2.5);
}

TEST(OverlayElement, CanBeTurnedOnAndOffWhilePlaying) {
  ElementHarness h("device=none");
  h.set_caps(make_caps("NV12", 320, 240));
  for (int n = 0; n < 9; ++n) {
    const bool on = n / 3 == 1;
    if (n % 3 == 0)
      g_object_set(h.element(), "overlay", on ? OverlayKind::kTracks : OverlayKind::kNone, nullptr);
    GstBuffer* frame = make_frame(h.info(), 2.0 * n, 0);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    ASSERT_EQ(h.push(frame, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    GstBuffer* out = gst_harness_pull(h.harness());
    EXPECT_EQ(differences(out, before) > 0, on) << "frame " << n;
    gst_buffer_unref(before);
    gst_buffer_unref(out);
  }
}

TEST(OverlayElement, DrawsWithinTheVisiblePart) {
  ElementHarness h("device=none overlay=tracks");
  h.set_caps(make_caps("GRAY8", 640, 480));
  for (int n = 0; n < 2; ++n) {
    GstBuffer* frame = make_frame(h.info(), 0, 0);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(frame);
    crop->x = 200;
    crop->y = 100;
    crop->width = 300;
    crop->height = 200;
    ASSERT_EQ(h.push(frame, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
    GstBuffer* out = gst_harness_pull(h.harness());
    GstMapInfo a, b;
    gst_buffer_map(out, &a, GST_MAP_READ);
    gst_buffer_map(before, &b, GST_MAP_READ);
    int inside = 0, outside = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        if (a.data[y * 640 + x] == b.data[y * 640 + x]) continue;
        ++(x >= 200 && x < 500 && y >= 100 && y < 300 ? inside : outside);
      }
    }
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(inside > 20, n == 1) << inside;
    gst_buffer_unmap(out, &a);
    gst_buffer_unmap(before, &b);
    gst_buffer_unref(before);
    gst_buffer_unref(out);
  }
}

}  // namespace
}  // namespace spidar::test::overlay_test
