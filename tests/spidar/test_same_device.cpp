// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device that is lost comes back only as itself: no force goes to another one that its name
/// means by then.
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::same_device_test {
namespace {

class SameDevice : public BusTest {
 protected:
  static std::unique_ptr<Grip> grip(const std::string& spec, const char* profile) {
    return make_grip(spec, load_profile(profile), unguarded());
  }
};

std::string reopening(Grip& grip) {
  grip.close();
  return opening(grip);
}

bool is_refused(const std::string& said) {
  return said.find("is another device than the one that was lost") != std::string::npos &&
         said.find("it gets no force") != std::string::npos;
}

/// A port of the bus, and which device is in it at first, then, and at the end.
struct Case {
  const char* spec;
  const char *kind, *then;
  const char *serial, *then_serial;
};

TEST_F(SameDevice, IsTheOnlyOneThatComesBackOnUsb) {
  for (const Case& c : {
           Case{"usb", "sh4", "sh4", "AAA", "BBB"},
           {"usb:1-1", "sh4", "sh4", "AAA", "BBB"},
           {"usb:1-1", "sh4", "sh4", "AAA", ""},
           {"usb:1-1", "sh4", "sh4", "", "BBB"},
           {"usb", "sh4", "simple", "", ""},
           {"falcon", "falcon", "falcon", "AAA", "BBB"},
       }) {
    SCOPED_TRACE(std::string(c.spec) + " " + c.serial + " " + c.then_serial);
    // Its source names no board.
    const auto grip = SameDevice::grip(c.spec, "spidar-g645");
    const auto plug_in = [](size_t port, const char* kind, const char* serial) {
      UsbPort& plugged = plug(port, kind, serial);
      plugged.memory.loaded = true;
      return &plugged;
    };
    plug_in(0, c.kind, c.serial);
    ASSERT_EQ(reopening(*grip), "");
    unplug(0);
    EXPECT_FALSE(is_refused(reopening(*grip)));
    const UsbPort* const other = plug_in(0, c.then, c.then_serial);
    const uint64_t updates = other->updates;
    for (int times = 0; times < 2; ++times) {
      const std::string said = reopening(*grip);
      EXPECT_TRUE(is_refused(said)) << said;
    }
    EXPECT_EQ(other->updates, updates) << "it was opened";
    // In another port if its serial number tells that it is the same.
    if (*c.serial) {
      plug_in(2, c.kind, c.serial);
    } else {
      unplug(0);
      plug_in(0, c.kind, c.serial);
    }
    EXPECT_EQ(reopening(*grip), "");
    expect_contains(grip->description(), *c.serial ? "1-3" : "1-1");
    clear_bus();
  }
}

TEST_F(SameDevice, WithoutASerialNumberIsInItsPortAndHasItsSwitch) {
  plug(0, "sh4").inputs = 0x30;
  const auto grip = SameDevice::grip("usb", "spidar-g645");
  ASSERT_EQ(reopening(*grip), "");
  unplug(0);
  plug(1, "sh4").inputs = 0x30;
  const std::string elsewhere = reopening(*grip);
  EXPECT_TRUE(is_refused(elsewhere)) << elsewhere;
  plug(0, "sh4").inputs = 0x50;
  const std::string other_switch = reopening(*grip);
  EXPECT_TRUE(is_refused(other_switch)) << other_switch;
  expect_contains(other_switch, "rotary switch 5");
  plug(0, "sh4").inputs = 0x30;
  EXPECT_EQ(reopening(*grip), "");
}

/// Other devices have the USB ID of this one, so they are no reason to report anything.
TEST_F(SameDevice, OfASharedIdIsAbsentUntilItIsBack) {
  plug(1, "mouse", "AAA");
  const auto mouse = SameDevice::grip("mouse", kDefaultProfile);
  ASSERT_EQ(reopening(*mouse), "");
  unplug(1);
  const UsbPort& other = plug(1, "mouse", "BBB");
  expect_contains(reopening(*mouse), "AAA is not plugged in");
  EXPECT_EQ(other.updates, 0u);
  plug(0, "mouse", "AAA");
  EXPECT_EQ(reopening(*mouse), "");
}

struct StickCase {
  const char* spec;
  EvdevIdentity first, other;
  EvdevKind kind = EvdevKind::kStick;
  bool comes_back = true;
};

TEST_F(SameDevice, IsTheOnlyOneThatComesBackAmongSticks) {
  for (const StickCase& c :
       {StickCase{"ff", {"1"}, {"2"}},
        {"ff", {"", "port 1"}, {"", "port 2"}},
        {"ff:/dev/input/event0", {"1"}, {"2"}},
        {"ff:/dev/input/event0", {"1", "port 1"}, {"", "port 1"}},
        {"ff:/dev/input/event0", {"", "port 1"}, {"", "port 1", "Another Stick"}},
        {"ff", {"", "port 1"}, {"", "port 1"}, EvdevKind::kWheel},
        // Nothing tells it from another one.
        {"ff", {"", ""}, {"", ""}, EvdevKind::kStick, false}}) {
    SCOPED_TRACE(std::string(c.spec) + " " + c.first.serial + " " + c.other.serial);
    plug_evdev(0, EvdevKind::kStick, nullptr, c.first);
    const FeltPlayer player(c.spec);
    player.push(1, 0);
    wait_for([] { return is_level(evdev_levels(0).right, 1, 1); });
    unplug_evdev(0);
    EvdevPort& other = plug_evdev(0, c.kind, nullptr, c.other);
    wait_for([&] { return !player.loop().refusal().empty(); });
    expect_contains(player.loop().refusal(), "it gets no force");
    EXPECT_TRUE(player.loop().lost());
    EXPECT_EQ(other.plays, 0u);
    EXPECT_EQ(other.settings, 0u);
    if (c.comes_back) {
      // Beside the other one, under another number.
      plug_evdev(4, EvdevKind::kStick, nullptr, c.first);
      wait_for([] { return is_level(evdev_levels(4).right, 1, 1); });
      EXPECT_TRUE(player.loop().refusal().empty());
      EXPECT_EQ(other.plays, 0u);
    }
    clear_bus();
  }
}

}  // namespace
}  // namespace spidar::test::same_device_test
