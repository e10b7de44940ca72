// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Borders and marks that are drawn into the video: pixels are read back.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "spidar/loop/haptic_loop.h"
#include "tests/support/canvas.h"

namespace spidar::test::overlay_shapes_test {
namespace {

TEST(Overlay, TheFeltArrowHasABorderOfOneWidthAllAround) {
  Canvas canvas("RGB", 641, 481);
  SceneView scene;
  scene.wrench.force_N = {0, 3, 0};
  canvas.draw(scene);
  // Up from (320, 240), 6 · 481 / 480 px wide, a fifth of 481 lines long. The head begins 4 widths
  // before the tip and is as wide there; the border is a quarter of a width.
  const double width_px = 6 * 481 / 480.0, margin_px = width_px / 4;
  const double tip_y = 240 - 481 / 5.0, neck_y = tip_y + 4 * width_px;
  const Pixel black{0, 0, 0}, white{255, 255, 255};
  // Beside the shaft: the head, its border, the picture.
  for (const int x : {312, 328}) {
    EXPECT_EQ(canvas.at(x, static_cast<int>(std::floor(neck_y))), white) << x;
    for (int y = static_cast<int>(std::ceil(neck_y)); y <= 180; ++y) {
      EXPECT_EQ(canvas.at(x, y), y <= neck_y + margin_px ? black : canvas.untouched())
          << "x " << x << ", " << y - neck_y << " px behind the head";
    }
  }
  // The sides lean by 1 in 2, so that along the arrow their border measures √5 times its width.
  const double along_px = std::sqrt(5.0) * margin_px;
  for (const int aside : {-4, -2, 2, 4}) {
    const double edge_y = tip_y + 2.0 * std::abs(aside);
    for (int y = static_cast<int>(edge_y) - 8; y < static_cast<int>(edge_y) + 3; ++y) {
      const Pixel expected = y >= edge_y              ? white
                             : y >= edge_y - along_px ? black
                                                      : canvas.untouched();
      EXPECT_EQ(canvas.at(320 + aside, y), expected) << aside << ", " << y - edge_y;
    }
  }
}

TEST(Overlay, ShowsFingerProxyAndTheForceOfTheContact) {
  const Pixel black{0, 0, 0}, white{255, 255, 255}, proxy{255, 160, 30};
  TouchMark touch;
  touch.finger = {0.25, 0.5};  // the middle between pixels 159 and 160, and 239 and 240
  Canvas canvas("RGB", 640, 480);
  canvas.draw({}, 1, 3, touch);
  // A ring of 11 px, a quarter of that thick, with a border of as much on either side.
  const double y = 239.5;
  for (int x = 160; x < 180; ++x) {
    const double away_px = std::hypot(x - 159.5, 239 - y);
    const Pixel expected = away_px > 11 * 1.25   ? canvas.untouched()
                           : away_px > 11        ? black
                           : away_px > 11 * 0.75 ? white
                           : away_px > 11 * 0.5  ? black
                                                 : canvas.untouched();
    EXPECT_EQ(canvas.at(x, 239), expected) << x;
  }
  EXPECT_EQ(canvas.at(480, 240), canvas.untouched()) << "it touches nothing";

  touch.touching = true;
  touch.proxy = {0.75, 0.5};
  touch.force_N = {3, 0, 3};  // to the right, and towards the viewer, each the most there is
  canvas.draw({}, 1, 3, touch);
  // A disc of 9 px with a border of an eighth of 11 px, over an arrow of a fifth of 480 lines.
  EXPECT_EQ(canvas.at(480, 240), proxy);
  EXPECT_EQ(canvas.at(480, 239 - 8), proxy);
  EXPECT_EQ(canvas.at(480, 239 - 9), black);
  EXPECT_EQ(canvas.at(480, 239 - 10), canvas.untouched());
  EXPECT_EQ(canvas.at(500, 240), white);
  EXPECT_EQ(canvas.at(480 + 94, 240), white);
  EXPECT_EQ(canvas.at(480 + 101, 240), canvas.untouched()) << "before its newtons";
}

TEST(Overlay, MarksOfTouchingAreClippedAtTheFrame) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const char* format : {"I420", "GRAY8", "P010_10LE"}) {
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(0, 0), {1, 1}, {1e9, -1e9}, {none, 0.5}}) {
      Canvas canvas(format, 33, 17);
      TouchMark touch;
      touch.touching = true;
      touch.finger = touch.proxy = place;
      touch.force_N = {3, 3, 3};
      canvas.draw({}, 1, 3, touch);
      EXPECT_TRUE(canvas.guards_hold()) << format;
      if (place == Eigen::Vector2d(1, 1)) {
        EXPECT_NE(canvas.at(32, 16), canvas.untouched()) << "the last pixel of an odd frame";
      }
    }
  }
}

int64_t read_time(void* time) {
  return *static_cast<int64_t*>(time);
}

TEST(OverlayElement, ShowsTheFingerOnlyWhileThePictureIsTouched) {
  for (const bool touching : {false, true}) {
    int64_t time_ns = 1'000'000'000;
    ElementHarness h(
        touching ? "device=sim overlay=tracks touch=luma" : "device=sim overlay=tracks touch=off",
        read_time, &time_ns);
    h.set_caps(make_caps("GRAY8", 320, 240));
    for (int tick = 0; tick < 300; ++tick) h.tick(time_ns += kTick_ns);  // until the device runs
    GstBuffer* frame = gst_buffer_new_allocate(nullptr, 320 * 240, nullptr);
    gst_buffer_memset(frame, 0, 20, 320 * 240);
    ASSERT_EQ(h.push(frame, 0), GST_FLOW_OK);
    GstBuffer* out = gst_harness_pull(h.harness());
    GstMapInfo map;
    gst_buffer_map(out, &map, GST_MAP_READ);
    // A ring of 5.5 px, 1.4 px thick, about the middle, where a hand holds the simulated grip.
    EXPECT_EQ(map.data[120 * 320 + 164], touching ? 255 : 20);
    EXPECT_EQ(map.data[120 * 320 + 160], 20) << "within the ring";
    gst_buffer_unmap(out, &map);
    gst_buffer_unref(out);
  }
}

}  // namespace
}  // namespace spidar::test::overlay_shapes_test
