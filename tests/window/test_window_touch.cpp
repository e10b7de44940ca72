// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Finger, relief and mouse in a debug window, without a window.
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "plugin/filter/frame/touch_view.h"
#include "plugin/window/program/model/relief_view.h"
#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"
#include "spidar/profiles/profile.h"

namespace spidar::test::window_touch_test {
namespace {

/// A few operations on numbers up to 1000.
constexpr double kRounding = 1e-12;
/// The picture in the window.
const Rect kPicture{100, 50, 400, 200};

/// 59 mm × 64 mm.
TouchMap gcc_map() {
  return {GripPointer(load_profile("spidar-gcc").geometry)};
}

TEST(TouchMap, PlaceAndPositionAreEachOthersReverse) {
  const TouchMap map = gcc_map();
  EXPECT_LT((map.place({0, 0, 0.01}) - Eigen::Vector2d(0.5, 0.5)).norm(), kRounding);
  const Eigen::Vector3d at_m(0.0295 / 2, 0.032 / 2, 0.003);  // to the right and up
  const Eigen::Vector2d place = map.place(at_m);
  EXPECT_LT((place - Eigen::Vector2d(0.75, 0.25)).norm(), kRounding);
  EXPECT_LT((map.position_m(place) - at_m.head<2>()).norm(), kRounding);
  EXPECT_LT((map.position_m({2, -1}) - Eigen::Vector2d(0.0295, 0.032)).norm(), kRounding)
      << "not beyond the picture";
}

TEST(TouchMark, IsWhereTheGripAndTheProxyAre) {
  TouchScene scene;
  TickRecord tick;
  tick.device = DeviceState::kRunning;
  tick.pose.position_m = {0.0295 / 2, 0, -0.002};
  EXPECT_FALSE(touch_mark(scene, tick)) << "touch=off";
  scene.on = true;
  scene.map = gcc_map();
  ASSERT_TRUE(touch_mark(scene, tick));
  EXPECT_FALSE(touch_mark(scene, tick)->touching);
  EXPECT_LT((touch_mark(scene, tick)->finger - Eigen::Vector2d(0.75, 0.5)).norm(), kRounding);
  tick.contact.touching = true;
  tick.contact.proxy_m = {0, 0.032 / 2, 0};
  tick.contact.force_N = {0, 0, 1.5};
  const TouchMark mark = *touch_mark(scene, tick);
  EXPECT_LT((mark.proxy - Eigen::Vector2d(0.5, 0.25)).norm(), kRounding);
  // Half of the largest force: half of the way from 3 to 9 px.
  EXPECT_NEAR(proxy_radius_px(mark, 3, 480), 6, kRounding);
  EXPECT_NEAR(proxy_radius_px(mark, 0, 480), 3, kRounding);
  tick.device = DeviceState::kLost;
  EXPECT_FALSE(touch_mark(scene, tick)) << "it is not known where the grip is";
}

TEST(MouseHand, HoldsTheGripWhereItIsPressedUntilItIsReleased) {
  MouseHand hand;
  const TouchMap map = gcc_map();
  Mouse mouse;
  mouse.at_px = {400, 100};  // three quarters from the left, a quarter from the top
  EXPECT_FALSE(hand.update(mouse, kPicture, map)) << "nothing is pressed";
  EXPECT_TRUE(hand.is_over());
  mouse.down = true;
  auto to_m = hand.update(mouse, kPicture, map);
  ASSERT_TRUE(to_m);
  EXPECT_LT((*to_m - Eigen::Vector3d(0.0295 / 2, 0.032 / 2, 0)).norm(), kRounding);
  mouse.at_px = {1000, 150};  // dragged out of the picture: its edge
  to_m = hand.update(mouse, kPicture, map);
  ASSERT_TRUE(to_m);
  EXPECT_LT((*to_m - Eigen::Vector3d(0.0295, 0, 0)).norm(), kRounding);
  mouse.at_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(hand.update(mouse, kPicture, map), to_m) << "the mouse has left the window";
  mouse.down = false;
  EXPECT_FALSE(hand.update(mouse, kPicture, map));
}

TEST(MouseHand, BeginsInThePictureOnlyAndNotOnAWidget) {
  MouseHand hand;
  const TouchMap map = gcc_map();
  Mouse mouse;
  mouse.down = true;
  mouse.at_px = {99, 100};
  EXPECT_FALSE(hand.update(mouse, kPicture, map));
  mouse.at_px = {300, 100};
  EXPECT_FALSE(hand.update(mouse, kPicture, map)) << "pressed outside and dragged in";
  mouse.down = false;
  hand.update(mouse, kPicture, map);
  mouse.down = mouse.taken = true;
  EXPECT_FALSE(hand.update(mouse, kPicture, map));
  mouse.wheel = 4;
  hand.update(mouse, kPicture, map);
  EXPECT_EQ(hand.z_m(), 0) << "the wheel is the widget's, too";
}

TEST(MouseHand, WheelAndShiftMoveItDeeperAndNearer) {
  MouseHand hand;
  const TouchMap map = gcc_map();
  Mouse mouse;
  mouse.at_px = {300, 150};
  mouse.down = true;
  mouse.wheel = 3;  // away from the user
  auto to_m = hand.update(mouse, kPicture, map);
  ASSERT_TRUE(to_m);
  EXPECT_NEAR(to_m->z(), -3 * MouseHand::kNotch_m, kRounding);
  mouse.wheel = 0;
  mouse.shift = true;
  mouse.at_px = {310, 130};  // a tenth of the picture up, of 64 mm
  to_m = hand.update(mouse, kPicture, map);
  ASSERT_TRUE(to_m);
  EXPECT_NEAR(to_m->z(), -3 * MouseHand::kNotch_m - 0.0064, kRounding);
  EXPECT_LT(to_m->head<2>().norm(), kRounding) << "where it was";
  mouse.wheel = -1000;
  EXPECT_NEAR(hand.update(mouse, kPicture, map)->z(), MouseHand::kFurthest_m, kRounding);
  hand.let_go();
  EXPECT_NEAR(hand.z_m(), MouseHand::kFurthest_m, kRounding) << "the depth stays";
}

/// A roof along the columns, 2 mm high in the middle, 0 at the left and right edge.
HeightField roof() {
  HeightField relief(0.06, 0.04);
  for (int y = 0; y < HeightField::kRows; ++y) {
    for (int x = 0; x < HeightField::kColumns; ++x) {
      relief.row(y)[x] = static_cast<float>(0.002 * (1 - std::fabs(relief.x_m(x)) / 0.03));
    }
  }
  return relief;
}

TEST(ReliefView, IsLitFromTheUpperLeft) {
  const std::vector<uint8_t> rgba = shade_relief(roof());
  ASSERT_EQ(rgba.size(), size_t{4} * HeightField::kCells);
  const auto grey = [&](int x, int y) {
    return rgba[4 * static_cast<size_t>(y * HeightField::kColumns + x)];
  };
  // A level surface has 0.15 + 0.85 · 1.6 / √4.56 of 255; slopes of 1/15 change that.
  const double left = 1.6 + 1 / 15.0, right = 1.6 - 1 / 15.0, size = std::sqrt(4.56 * 226 / 225);
  EXPECT_NEAR(grey(60, 70), 255 * (0.15 + 0.85 * left / size), 0.6);
  EXPECT_NEAR(grey(200, 70), 255 * (0.15 + 0.85 * right / size), 0.6);
}

TEST(ReliefView, ASectionHasTheHeightsOfTheSurface) {
  const HeightField relief = roof();
  const auto section = relief_section(relief, 0.01, 5);
  ASSERT_EQ(section.size(), 5u);
  for (const Eigen::Vector2d& at_m : section) {
    EXPECT_EQ(at_m.y(), relief.at(at_m.x(), 0.01).z_m);
  }
  EXPECT_NEAR(section[0].x(), -0.03, kRounding);
  EXPECT_NEAR(section[4].x(), 0.03, kRounding);
  EXPECT_GT(section[2].y(), section[1].y());
}

TEST(ReliefView, TheTouchedPointLiesOnTheSectionThatIsDrawn) {
  const HeightField relief = roof();
  TickRecord tick;
  // Friction holds it back from where the grip is, and between two frames the surface is 0.5 mm
  // nearer than in either.
  tick.pose.position_m = {0.004, 0.01, -0.001};
  tick.contact.touching = true;
  tick.contact.proxy_m = {0.0075, -0.005, relief.at(0.0075, -0.005).z_m + 0.0005};
  const auto section = touched_section(relief, tick, 9);
  // Every 7.5 mm: the sixth of them.
  EXPECT_NEAR(section[5].x(), 0.0075, kRounding);
  EXPECT_NEAR(section[5].y(), tick.contact.proxy_m.z(), kRounding);
  tick.contact.touching = false;
  EXPECT_EQ(touched_section(relief, tick, 9), relief_section(relief, 0.01, 9));
}

TEST(ReliefView, SaysHowFarTheSurfaceIs) {
  TouchScene scene;
  TickRecord tick;
  EXPECT_EQ(depth_line(scene, tick), "") << "no relief yet";
  scene.relief = std::make_shared<HeightField>(0.06, 0.04);
  tick.pose.position_m = {0, 0, 0.0032};
  EXPECT_EQ(depth_line(scene, tick), "3.2 mm in front");
  tick.contact.touching = true;
  tick.contact.depth_m = 0.0014;
  EXPECT_EQ(depth_line(scene, tick), "1.4 mm deep");
}

TEST(FeltLine, SaysWhyNothingIsFeltAndThatASlowDeviceIsTouchedWithLess) {
  ElementState state;
  state.settings = {{"touch-stiffness", "", Setting::Kind::kNumber, 700, 10, 800, {}}};
  TouchScene touch;
  touch.stiffness_N_m = 400;
  EXPECT_EQ(felt_line(state, touch), "felt") << "touch=off";
  touch.on = true;
  EXPECT_EQ(felt_line(state, touch),
            "felt, at 400 N/m instead of 700: the device's drives are slow");
  touch.stiffness_N_m = 700;
  EXPECT_EQ(felt_line(state, touch), "felt");
  state.no_force = "the grip is in front of the surface";
  EXPECT_EQ(felt_line(state, touch), "not felt: " + state.no_force);
}

}  // namespace
}  // namespace spidar::test::window_touch_test
