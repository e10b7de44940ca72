// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Wheels are not taken for joysticks, nor joysticks for wheels.
#include "spidar/devices/force_feedback/evdev_list.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::wheels_test {
namespace {

constexpr const char* kOneAxis =
    " at 20 % of its strength, force feedback on one axis: forces up and down are not felt";
constexpr const char* kTwoAxes = " at 20 % of its strength, force feedback on two axes";

class Wheels : public BusTest {};

EvdevTraits traits(const std::string& name, std::initializer_list<unsigned> axes,
                   std::initializer_list<unsigned> keys = {}) {
  EvdevTraits device;
  name.copy(device.name.data(), device.name.size() - 1);
  const auto set = [](auto& bits, unsigned bit) {
    bits[bit / 8] = static_cast<uint8_t>(bits[bit / 8] | 1 << bit % 8);
  };
  for (const unsigned axis : axes) set(device.axes, axis);
  for (const unsigned key : keys) set(device.keys, key);
  return device;
}

TEST(IsWheel, KnowsAxesButtonsNamesAndIds) {
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_WHEEL})));
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_X, ABS_Y, ABS_GAS})));
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_X, ABS_Y, ABS_BRAKE})));
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_X, ABS_Y, ABS_Z, ABS_RZ})));
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_X, ABS_Y}, {BTN_GEAR_UP})));
  EXPECT_TRUE(is_wheel(traits("Base", {ABS_X, ABS_Y}, {BTN_WHEEL})));
  EXPECT_TRUE(is_wheel(traits("A Racing WHEEL", {ABS_X, ABS_Y})));
  EvdevTraits wingman = traits("Logitech Inc. WingMan Formula Force", {ABS_X, ABS_Y});
  EXPECT_FALSE(is_wheel(wingman));
  wingman.vendor = 0x046d;
  wingman.product = 0xc293;
  EXPECT_TRUE(is_wheel(wingman));
  EvdevTraits thrustmaster = traits("Thrustmaster FGT", {ABS_X, ABS_Y});
  thrustmaster.vendor = 0x044f;
  thrustmaster.product = 0xb654;
  EXPECT_TRUE(is_wheel(thrustmaster));
}

TEST(IsWheel, JoysticksAreNone) {
  EvdevTraits force_3d =
      traits("Logitech Inc. Logitech Force 3D Pro", {ABS_X, ABS_Y, ABS_RZ, ABS_THROTTLE},
             {BTN_TRIGGER, BTN_THUMB, BTN_TOP});
  force_3d.vendor = 0x046d;
  force_3d.product = 0xc286;
  EXPECT_FALSE(is_wheel(force_3d));
  EXPECT_FALSE(is_wheel(traits("FFB Joystick", {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ})));
}

/// By what they report, their USB ID or their pedals. A second effect would turn them: a force
/// upwards to the left.
TEST_F(Wheels, GetTheSidewaysForceOnly) {
  for (const EvdevKind kind : {EvdevKind::kWheel, EvdevKind::kWheelBase, EvdevKind::kPedalBase}) {
    EvdevPort& port = plug_evdev(0, kind);
    port.axis[1] = 1000;  // a pedal
    const FeltPlayer player;
    player.push(-1, 1);
    wait_for([] { return is_level(evdev_levels(0).right, -1, 1); });
    EXPECT_EQ(evdev_levels(0).up, 0);
    const GripAbilities can = player.session->grip().abilities();
    EXPECT_TRUE(can.force[0] && can.direction);
    EXPECT_FALSE(can.force[1]);
    EXPECT_EQ(player.now().last.pose.position_m.y(), 0);
    EXPECT_FALSE(port.effect[1].used);
  }
}

/// hid-pidff plays every effect of such a wheel to the left if its level is positive.
TEST_F(Wheels, RightIsRightOnWheelsThatIgnoreTheDirection) {
  plug_evdev(0, EvdevKind::kWheelBase);
  const FeltPlayer player;
  for (const double x_N : {1.5, -0.7}) {
    player.push(x_N, 0);
    wait_for([x = x_N] { return is_level(evdev_levels(0).right, x, std::abs(x)); });
  }
}

TEST_F(Wheels, WhatTheIdSaysIsDescribedAndCanBeOverridden) {
  const auto described = [](EvdevKind kind, const std::string& option) {
    plug_evdev(0, kind);
    return FeltPlayer("ff:/dev/input/event0" + option).session->grip().description();
  };
  constexpr const char* kSpring = "; its driver cannot switch a centring spring off";
  EXPECT_EQ(described(EvdevKind::kWheelBase, ""),
            "MOZA R5 Base at 20 % of its strength, force feedback on one axis, as its USB ID says: "
            "forces up and down are not felt");
  EXPECT_EQ(described(EvdevKind::kWheelBase, ",axes=2"), std::string("MOZA R5 Base") + kTwoAxes);
  EXPECT_EQ(described(EvdevKind::kFlightBase, ""),
            std::string("MOZA AB9 FFB Base") + kTwoAxes + ", as its USB ID says" + kSpring);
  EXPECT_EQ(described(EvdevKind::kFlightBase, ",axes=1"),
            std::string("MOZA AB9 FFB Base") + kOneAxis + kSpring);
}

TEST_F(Wheels, TheNumberOfAxesCanBeNamed) {
  const auto described = [](const std::string& device) {
    plug_evdev(0, EvdevKind::kStick);
    plug_evdev(1, EvdevKind::kPedalBase);
    return FeltPlayer(device).session->grip().description();
  };
  EXPECT_EQ(described("ff:/dev/input/event0"), std::string("Emulated Stick") + kTwoAxes);
  EXPECT_EQ(described("ff:/dev/input/event0,axes=2"), std::string("Emulated Stick") + kTwoAxes);
  EXPECT_EQ(described("ff:/dev/input/event0,axes=1"), std::string("Emulated Stick") + kOneAxis);
  EXPECT_EQ(described("ff:/dev/input/event1"), std::string("Emulated Base") + kOneAxis);
  EXPECT_EQ(described("ff:/dev/input/event1,axes=2"), std::string("Emulated Base") + kTwoAxes);
  const DeviceInfo board = board_info("ff:/dev/input/event1,axes=2");
  EXPECT_EQ(board.device, "ff:/dev/input/event1,axes=2");
  EXPECT_EQ(board.name, "Emulated Base");
}

TEST_F(Wheels, BadNumbersOfAxesAreRefused) {
  const auto says = [](const std::string& device) {
    return message_of<DeviceError>([&] { const FeltPlayer player(device); });
  };
  for (const char* bad : {"axes=3", "axes=0", "axes=", "axes", "wheel", "", "gain=0", "gain=101",
                          "gain=1e1", "gain=", "flip=", "flip=z"})
    EXPECT_EQ(says(std::string("ff:/dev/input/event0,") + bad),
              std::string("ff:/dev/input/event0,") + bad + ": \"" + bad +
                  "\" is unknown, out of range or given twice; write ff:/dev/input/event0,axes=1 "
                  "for a wheel, "
                  "ff:/dev/input/event0,axes=2 for a joystick, ff:/dev/input/event0,gain=50 for "
                  "50 % of the device's strength (1 to 100), or ff:/dev/input/event0,flip=x if it "
                  "pushes to "
                  "the wrong side");
  expect_contains(says("ff:/dev/input/event0,axes=1,axes=1"),
                  "\"axes=1\" is unknown, out of range or given twice");
  EXPECT_EQ(says("ff:,axes=1"), "ff:,axes=1: the path is empty; write ff:/dev/input/eventN,axes=1");
  plug_evdev(0, EvdevKind::kOneAxis);
  EXPECT_EQ(says("ff:/dev/input/event0,axes=2"),
            "ff:/dev/input/event0,axes=2: \"Emulated Dial\" does not have two axes (ABS_X and "
            "ABS_Y); write ff:/dev/input/event0,axes=1");
}

}  // namespace
}  // namespace spidar::test::wheels_test
