// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Finger and mouse in a debug window, without a window.
#include "plugin/filter/display/element_source.h"
#include "plugin/frame/touch_view.h"
#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"
#include "spidar/profiles/profile.h"
#include "tests/support/test.h"

namespace spidar::test::window_touch_test {
namespace {

/// A few operations on numbers up to 1000.
constexpr double kRounding = 1e-12;
/// The picture in the window.
const window::Rect kPicture{100, 50, 400, 200};

/// 59 mm × 64 mm.
GripPointer gcc_pointer() {
  return GripPointer(load_profile("spidar-gcc").geometry);
}

TEST(GripPointer, PlaceAndPositionAreEachOthersReverse) {
  const GripPointer pointer = gcc_pointer();
  EXPECT_LT((pointer.position({0, 0, 0.01}) - Eigen::Vector2d(0.5, 0.5)).norm(), kRounding);
  const Eigen::Vector3d at_m(0.0295 / 2, 0.032 / 2, 0.003);  // to the right and up
  const Eigen::Vector2d position = pointer.position(at_m);
  EXPECT_LT((position - Eigen::Vector2d(0.75, 0.25)).norm(), kRounding);
  EXPECT_LT((pointer.position_m(position) - at_m.head<2>()).norm(), kRounding);
  EXPECT_LT((pointer.position_m({2, -1}) - Eigen::Vector2d(0.0295, 0.032)).norm(), kRounding)
      << "not beyond the picture";
}

TEST(TouchMark, IsWhereTheGripAndTheProxyAre) {
  TouchScene scene;
  TickRecord tick;
  tick.device = DeviceState::kRunning;
  tick.pose.position_m = {0.0295 / 2, 0, -0.002};
  EXPECT_FALSE(touch_mark(scene, tick)) << "touch=off";
  scene.on = true;
  scene.pointer = gcc_pointer();
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
  window::MouseHand hand;
  const GripPointer pointer = gcc_pointer();
  window::Mouse mouse;
  mouse.at_px = {400, 100};  // three quarters from the left, a quarter from the top
  EXPECT_FALSE(hand.update(mouse, kPicture, pointer)) << "nothing is pressed";
  EXPECT_TRUE(hand.is_over());
  mouse.down = true;
  auto to_m = hand.update(mouse, kPicture, pointer);
  ASSERT_TRUE(to_m);
  EXPECT_LT((*to_m - Eigen::Vector3d(0.0295 / 2, 0.032 / 2, 0)).norm(), kRounding);
  mouse.at_px = {1000, 150};  // dragged out of the picture: its edge
  to_m = hand.update(mouse, kPicture, pointer);
  ASSERT_TRUE(to_m);
  EXPECT_LT((*to_m - Eigen::Vector3d(0.0295, 0, 0)).norm(), kRounding);
  mouse.at_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(hand.update(mouse, kPicture, pointer), to_m) << "the mouse has left the window";
  mouse.down = false;
  EXPECT_FALSE(hand.update(mouse, kPicture, pointer));
}

TEST(MouseHand, BeginsInThePictureOnlyAndNotOnAWidget) {
  window::MouseHand hand;
  const GripPointer pointer = gcc_pointer();
  window::Mouse mouse;
  mouse.down = true;
  mouse.at_px = {99, 100};
  EXPECT_FALSE(hand.update(mouse, kPicture, pointer));
  mouse.at_px = {300, 100};
  EXPECT_FALSE(hand.update(mouse, kPicture, pointer)) << "pressed outside and dragged in";
  mouse.down = false;
  hand.update(mouse, kPicture, pointer);
  mouse.down = mouse.taken = true;
  EXPECT_FALSE(hand.update(mouse, kPicture, pointer));
  mouse.wheel = 4;
  hand.update(mouse, kPicture, pointer);
  EXPECT_EQ(hand.z_m(), 0) << "the wheel is the widget's, too";
}

TEST(MouseHand, WheelAndShiftMoveItDeeperAndNearer) {
  window::MouseHand hand;
  const GripPointer pointer = gcc_pointer();
  window::Mouse mouse;
  mouse.at_px = {300, 150};
  mouse.down = true;
  mouse.wheel = 3;  // away from the user
  auto to_m = hand.update(mouse, kPicture, pointer);
  ASSERT_TRUE(to_m);
  EXPECT_NEAR(to_m->z(), -3 * window::MouseHand::kNotch_m, kRounding);
  mouse.wheel = 0;
  mouse.shift = true;
  mouse.at_px = {310, 130};  // a tenth of the picture up, of 64 mm
  to_m = hand.update(mouse, kPicture, pointer);
  ASSERT_TRUE(to_m);
  EXPECT_NEAR(to_m->z(), -3 * window::MouseHand::kNotch_m - 0.0064, kRounding);
  EXPECT_LT(to_m->head<2>().norm(), kRounding) << "where it was";
  mouse.wheel = -1000;
  EXPECT_NEAR(hand.update(mouse, kPicture, pointer)->z(), window::MouseHand::kFurthest_m,
              kRounding);
  hand.release();
  EXPECT_NEAR(hand.z_m(), window::MouseHand::kFurthest_m, kRounding) << "the depth stays";
}

TEST(FeltLine, SaysWhyNothingIsFeltAndThatASlowDeviceIsTouchedWithLess) {
  window::ElementState state;
  state.settings = {{"touch-stiffness", "", window::Setting::Kind::kNumber, 700, 10, 800, {}}};
  TouchScene touch;
  touch.stiffness_N_m = 400;
  const Wrench felt{{0, 1, 0}, {}};
  EXPECT_EQ(window::felt_line(state, touch, felt), "felt") << "touch=off";
  EXPECT_EQ(window::felt_line(state, touch, {}), "felt within the last second");
  touch.on = true;
  EXPECT_EQ(window::felt_line(state, touch, felt),
            "felt, at 400 N/m instead of 700: the device's drives are slow");
  touch.stiffness_N_m = 700;
  EXPECT_EQ(window::felt_line(state, touch, felt), "felt");
  state.no_force = "the grip is in front of the surface";
  EXPECT_EQ(window::felt_line(state, touch, {}), "not felt: " + state.no_force);
  state.no_force = sentence(NoForceReason::kVibration);
  EXPECT_EQ(window::felt_line(state, touch, felt), "felt: " + state.no_force);
}

TEST(FeltLine, TellsAPauseFromASeekAndFromTheEnd) {
  EXPECT_EQ(filter::sentence_in_window(NoForceReason::kNoFrames, false), "The video is paused.");
  EXPECT_EQ(filter::sentence_in_window(NoForceReason::kNotPlaying, true),
            "The video is seeking, or its clock stands still.");
  for (const bool is_playing : {false, true}) {
    EXPECT_EQ(filter::sentence_in_window(NoForceReason::kEnded, is_playing), "The film has ended.");
  }
  EXPECT_EQ(filter::sentence_in_window(NoForceReason::kNone, true), "");
}

}  // namespace
}  // namespace spidar::test::window_touch_test
