// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The overlay in the video, read back from the pixels.
#include <tuple>

#include "plugin/overlay/arrow.h"
#include "spidar/loop/haptic_loop.h"
#include "tests/support/canvas.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_formats.h"
#include "tests/support/video_frames.h"

namespace spidar::test::overlay_test {
namespace {

constexpr Pixel kWhitePixel{255, 255, 255}, kBlackPixel{0, 0, 0}, kOrange{255, 160, 30};

/// Edges are soft.
bool is_dark(const Pixel& pixel) {
  return pixel[0] < 128 && pixel[1] < 128 && pixel[2] < 128;
}

DrawnFrame one_point(ImagePoint from, ImagePoint to, PointOwner owner = PointOwner::kUnknown) {
  DrawnFrame report;
  report.points.push_back({1, from, to, owner, 0, false});
  return report;
}

TEST(Overlay, IsDrawnIntoEveryFormat) {
  for (const std::string& format :
       formats_in(SPIDAR_VIDEO_FORMATS + std::string(SPIDAR_UNPACKED_FORMATS))) {
    for (const auto& [width, height] : {std::pair{64, 48}, {65, 49}, {67, 33}}) {
      SCOPED_TRACE(format + ", " + std::to_string(width) + "x" + std::to_string(height));
      Canvas canvas(format.c_str(), width, height);
      canvas.draw(one_point({10, 20}, {16, 20}), 4);
      EXPECT_TRUE(canvas.is_drawn(10, 20)) << "tail";
      EXPECT_TRUE(canvas.is_drawn(22, 20)) << "shaft";
      EXPECT_TRUE(canvas.is_drawn(32, 20)) << "four times the displacement, less a soft tip";
      // The head is max(min(12, 4 · 1.5) / 2, 1.5) = 3 px to either side where it begins, 6 px
      // before the tip; the shaft is one. A sample of colour may be that of four pixels beside each
      // other.
      for (const auto& [x, y] :
           {std::pair{3, 20}, {42, 20}, {20, 14}, {20, 27}, {28, 12}, {28, 29}}) {
        EXPECT_FALSE(canvas.is_drawn(x, y)) << x << "," << y;
      }
      EXPECT_TRUE(canvas.guards_hold());
    }
  }
}

TEST(Overlay, WhatIsOutsideTheFrameIsClipped) {
  const float far = 1e9F, none = std::numeric_limits<float>::quiet_NaN();
  for (const char* format : {"I420", "GRAY8", "P010_10LE", "RGB", "YUY2"}) {
    SCOPED_TRACE(format);
    Canvas canvas(format, 33, 17);
    for (const auto& [from, to] : {std::pair<ImagePoint, ImagePoint>{{-5, 3}, {40, 3}},
                                   {{3, -9}, {3, 30}},
                                   {{30, 16}, {50, 40}},
                                   {{0, 0}, {-7, -7}},
                                   {{-far, 8}, {far, 8}},
                                   {{8, far}, {8, far}},
                                   {{none, 1}, {2, 2}},
                                   {{32, 16}, {32, 16}}}) {
      canvas.draw(one_point(from, to));
    }
    EXPECT_TRUE(canvas.is_drawn(2, 3));
    EXPECT_TRUE(canvas.is_drawn(3, 12));
    EXPECT_TRUE(canvas.is_drawn(32, 16)) << "the last pixel of an odd frame";
    for (const Eigen::Vector2d& position :
         {Eigen::Vector2d(0, 0), {1, 1}, {1e9, -1e9}, {static_cast<double>(none), 0.5}}) {
      DrawnFrame report;
      TouchMark& touch = report.touch_mark.emplace();
      touch.touching = true;
      touch.finger = touch.proxy = position;
      touch.force_N = {3, 3, 3};
      canvas.draw(report);
    }
    EXPECT_TRUE(canvas.guards_hold());
  }
}

TEST(Overlay, TracksAreDrawnOnlyWhenAskedFor) {
  DrawnFrame report = one_point({10, 20}, {34, 20});
  report.lost.push_back({50, 10});
  MovingObject object;
  object.points = 5;
  object.size_px = {20, 10};
  report.frame.objects.push_back(object);
  for (const bool has_points : {false, true}) {
    Canvas canvas("RGB", 64, 48);
    canvas.draw(report, 1, has_points);
    EXPECT_EQ(canvas.is_drawn(16, 20), has_points);
    EXPECT_EQ(canvas.is_drawn(50, 10), has_points);
    EXPECT_TRUE(canvas.is_drawn(32, 19)) << "the upper side of the object's box";
  }
}

TEST(Overlay, ColoursSayTheDirectionAndTheOwner) {
  const auto color = [](double right, double down, double saturation) {
    const Rgb found = direction_color({right, down}, saturation);
    return Pixel{found.r, found.g, found.b};
  };
  EXPECT_EQ(color(1, 0, 1), (Pixel{255, 0, 0}));
  EXPECT_EQ(color(0, -1, 1), (Pixel{128, 255, 0}));  // up: 90 degrees, half way yellow to green
  EXPECT_EQ(color(-1, 0, 1), (Pixel{0, 255, 255}));
  EXPECT_EQ(color(0, 1, 1), (Pixel{128, 0, 255}));
  EXPECT_EQ(color(1, 0, 0), kWhitePixel);

  Canvas background("RGB", 640, 480), object("RGB", 640, 480);
  background.draw(one_point({100, 99}, {200, 99}, PointOwner::kBackground));
  object.draw(one_point({100, 99}, {200, 99}, PointOwner::kObject));
  EXPECT_EQ(object.at(150, 99), (Pixel{255, 0, 0}));
  // 255 (1 − 0.45), less where the edges of a line are soft that is a pixel wide.
  EXPECT_NEAR(background.at(150, 99)[1], 140, 20);
  EXPECT_GT(background.at(150, 99)[0], 200);
}

TEST(Overlay, TheFeltForceIsOneBoldArrowFromTheMiddle) {
  Canvas canvas("RGB", 641, 481);
  DrawnFrame report;
  report.frame.wrench.force_N = {0, 3, 0};  // up, the most there is
  canvas.draw(report);
  // Tail at (320, 240), a fifth of 481 lines long, 6 px wide; the border is a quarter of that. The
  // head begins four widths before the tip and is as wide there.
  const int tip_y = 240 - 96, neck_y = tip_y + 24;
  for (const int y : {236, 200, neck_y + 4, tip_y + 6}) EXPECT_EQ(canvas.at(320, y), kWhitePixel);
  EXPECT_EQ(canvas.at(329, neck_y - 1), kWhitePixel) << "the head";
  EXPECT_TRUE(canvas.is_drawn(324, 200) && is_dark(canvas.at(324, 200))) << "its border";
  EXPECT_TRUE(canvas.is_drawn(328, neck_y + 2) && is_dark(canvas.at(328, neck_y + 2)));
  EXPECT_FALSE(canvas.is_drawn(328, 200)) << "beside the shaft";
  EXPECT_FALSE(canvas.is_drawn(320, 260));
  EXPECT_FALSE(canvas.is_drawn(320, tip_y - 10)) << "before its newtons";

  for (const auto& [force_N, max_force_N] : {std::pair{0.0, 3.0}, {3.0, 0.0}}) {
    Canvas none("RGB", 641, 481);
    report.frame.wrench.force_N = {0, force_N, 0};
    report.controller.max_force_N = max_force_N;
    none.draw(report);
    EXPECT_FALSE(none.is_drawn(320, 240)) << force_N << " of " << max_force_N;
  }
}

TEST(Overlay, AnObjectHasItsBoxAndTheFeltOneAThickOneFromWhichTheArrowBegins) {
  Canvas canvas("RGB", 641, 481);
  DrawnFrame report;
  report.frame.objects.resize(3);
  for (uint32_t i = 0; i < 3; ++i) {
    MovingObject& object = report.frame.objects[i];
    object.id = i + 1;
    object.points = i == 2 ? 0 : 5;  // the last one is out of sight
    object.position_px = {-200 + 200.0 * i, 60};
    object.size_px = {80, 40};
  }
  report.frame.wrench.force_N = {3, 0, 0};
  report.felt = {1};
  canvas.draw(report);
  // The boxes are around (120, 300), (320, 300) and (520, 300).
  EXPECT_EQ(canvas.at(80, 310), kOrange);
  EXPECT_EQ(canvas.at(78, 310), kBlackPixel) << "2 px wide, in 4 px of black";
  EXPECT_EQ(canvas.at(280, 316), kWhitePixel);
  EXPECT_FALSE(canvas.is_drawn(283, 316));
  EXPECT_FALSE(canvas.is_drawn(480, 310));
  // A fifth of 481 lines to the right, from the middle of the felt one.
  EXPECT_EQ(canvas.at(122, 300), kWhitePixel);
  EXPECT_EQ(canvas.at(120 + 90, 300), kWhitePixel);
  EXPECT_FALSE(canvas.is_drawn(320, 240)) << "nothing in the middle of the picture";
}

TEST(Overlay, TheCurveEndsAtTheForceOfNowWhicheverWayThePictureIsTurned) {
  constexpr int kSide = 480;
  constexpr int64_t kSecond_ns = 1'000'000'000;
  ForceCurve curve;
  curve.add(0, 1.2);  // gone by the end: 7 s before it
  for (int i = 0; i <= 100; ++i) curve.add(2 * kSecond_ns + i * kSecond_ns / 20, i < 50 ? 0 : 1);
  EXPECT_EQ(curve.axis().high, 2) << "for 1.2 N, which the stream has had";
  EXPECT_EQ(curve.positions().size(), 101u);
  for (int quarters = 0; quarters < 4; ++quarters) {
    SCOPED_TRACE(quarters);
    DrawnFrame report;
    report.turn = Orientation(quarters);
    Canvas canvas("RGB", kSide, kSide);
    canvas.draw(report, 1, false, &curve);
    const auto shown = [&](const Canvas& of, double x, double y) {
      const Eigen::Vector2d position = report.turn.stored_position(Eigen::Vector2d(x, y));
      return of.at(static_cast<int>(kSide * position.x()), static_cast<int>(kSide * position.y()));
    };
    // 0 N is 2 % of the height above the lower edge, and 2 N 12 % more; the end is at 98.5 %.
    EXPECT_EQ(shown(canvas, 0.985, 0.92), kOrange) << "1 N";
    EXPECT_EQ(shown(canvas, 0.7, 0.92), kOrange);
    EXPECT_EQ(shown(canvas, 0.25, 0.98), kOrange) << "0 N";
    EXPECT_NEAR(shown(canvas, 0.25, 0.92)[0], 77 / 2, 2) << "between, half of the grey";
    EXPECT_EQ(shown(canvas, 0.25, 0.8), (Pixel{77, 77, 77})) << "above the strip";
    EXPECT_TRUE(canvas.guards_hold());
    // Away from subtitles: all of it 83 % of the height higher.
    report.has_subtitles = true;
    Canvas subtitled("RGB", kSide, kSide);
    subtitled.draw(report, 1, false, &curve);
    EXPECT_EQ(shown(subtitled, 0.7, 0.09), kOrange) << "1 N";
    EXPECT_EQ(shown(subtitled, 0.25, 0.15), kOrange) << "0 N";
    EXPECT_EQ(shown(subtitled, 0.25, 0.92), (Pixel{77, 77, 77}));
  }
}

TEST(Overlay, ACurveBeginsAnewWithItsStreamAndHasARoundAxis) {
  ForceCurve curve;
  EXPECT_TRUE(curve.positions().empty());
  EXPECT_EQ(curve.axis().high, ForceCurve::kMinTop_N);
  curve.add(5'000'000, 2.1);
  EXPECT_EQ(curve.axis().high, 3) << "and not 5, at which the curve would jump to two thirds";
  curve.add(4'000'000, 0.1);
  EXPECT_EQ(curve.positions().size(), 1u);
  EXPECT_EQ(curve.axis().high, ForceCurve::kMinTop_N);
}

/// The pixels of the newtons beyond the tip of an arrow to the right, in a picture of 481 x 481, as
/// they are shown: positions from the upper left one on, and colours.
std::vector<std::tuple<int, int, Pixel>> newtons(const Orientation& turn) {
  constexpr int kSide = 481, kMiddle = kSide / 2;
  Canvas canvas("RGB", kSide, kSide);
  DrawnFrame report;
  report.turn = turn;
  report.frame.wrench.force_N = {1, 0, 0};  // "1.0 N", beyond an arrow of 481 / 5 / 3 = 32 px
  canvas.draw(report);
  std::vector<std::tuple<int, int, Pixel>> found;
  int left = kSide, top = kSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = kMiddle + 40; x < kSide; ++x) {
      const Eigen::Vector2d at_px = turn.to_stored(Eigen::Vector2d(x - kMiddle, y - kMiddle));
      const int coded_x = kMiddle + static_cast<int>(at_px.x());
      const int coded_y = kMiddle + static_cast<int>(at_px.y());
      if (!canvas.is_drawn(coded_x, coded_y)) continue;
      left = std::min(left, x);
      top = std::min(top, y);
      found.emplace_back(x, y, canvas.at(coded_x, coded_y));
    }
  }
  for (auto& [x, y, pixel] : found) x -= left, y -= top;
  return found;
}

TEST(Overlay, NewtonsStandBeyondTheTipOfTheArrowUprightAsItIsShown) {
  const auto upright = newtons({});
  ASSERT_GT(upright.size(), 300u) << "five letters of 17 px";
  for (const bool mirrored : {false, true}) {
    for (int quarters = 0; quarters < 4; ++quarters) {
      EXPECT_EQ(newtons(Orientation(quarters, mirrored)), upright) << quarters << mirrored;
    }
  }
}

TEST(Overlay, ShowsFingerProxyAndTheForceOfTheContact) {
  DrawnFrame report;
  TouchMark& touch = report.touch_mark.emplace();
  touch.finger = {0.25, 0.5};  // the middle between pixels 159 and 160, and 239 and 240
  Canvas canvas("RGB", 640, 480);
  canvas.draw(report);
  // A ring of 11 px, a quarter of that thick, with a border of as much on either side.
  EXPECT_FALSE(canvas.is_drawn(160, 239)) << "within the ring";
  EXPECT_EQ(canvas.at(159 + 7, 239), kBlackPixel);
  EXPECT_EQ(canvas.at(159 + 10, 239), kWhitePixel);
  EXPECT_TRUE(canvas.is_drawn(159 + 13, 239) && is_dark(canvas.at(159 + 13, 239)));
  EXPECT_FALSE(canvas.is_drawn(159 + 17, 239));
  EXPECT_FALSE(canvas.is_drawn(480, 240)) << "it touches nothing";

  touch.touching = true;
  touch.proxy = {0.75, 0.5};
  touch.force_N = {3, 0, 3};  // to the right, and towards the viewer, each the most there is
  canvas.draw(report);
  // A disc of 9 px with a border of an eighth of 11 px, over an arrow of a fifth of 480 lines.
  EXPECT_EQ(canvas.at(480, 240), kOrange);
  EXPECT_EQ(canvas.at(480, 239 - 7), kOrange);
  EXPECT_NE(canvas.at(480, 239 - 9), kOrange);
  EXPECT_FALSE(canvas.is_drawn(480, 239 - 12));
  EXPECT_EQ(canvas.at(500, 240), kWhitePixel);
  EXPECT_EQ(canvas.at(480 + 70, 240), kWhitePixel);
}

}  // namespace
}  // namespace spidar::test::overlay_test
