// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// libgst-spidar with devices that are plugged in and out: on an emulated bus, behind the calls of
// real ones.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gst-spidar/c-api.h>
#include <gst-spidar/device.h>
#include <gtest/gtest.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"

namespace gst_spidar {
namespace {

using namespace std::chrono_literals;
using spidar::test::EvdevKind;
using spidar::test::EvdevPort;

/// The guardian is another process.
const spidar::test::SharedBus shared_bus;

/// Events that take milliseconds, or a second to open a device again; the limit is generous for a
/// busy machine.
bool happens(const std::function<bool()>& what) {
  const auto until = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < until) {
    if (what()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

class Plugged : public testing::Test {
 protected:
  ~Plugged() override { spidar::test::clear_bus(); }

  EvdevPort& stick = spidar::test::plug_evdev(0, EvdevKind::kStick);
};

Wrench half_a_newton() {
  Wrench wrench;
  wrench.force_N.x = 0.5;
  return wrench;
}

TEST_F(Plugged, AStickIsListedAndTellsItsButtons) {
  const std::vector<std::string> names = list_devices();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "ff:/dev/input/event0");
  std::atomic<std::uint32_t> seen{0};
  Device device(names.front());
  EXPECT_EQ(device.capabilities().buttons, 3);
  EXPECT_EQ(device.buttons(), 0u);
  device.set_callback([&](const GripState& grip) {
    seen = grip.buttons;
    return Wrench{};
  });
  stick.pressed = 0b010;  // BTN_TRIGGER, the first of joysticks
  EXPECT_TRUE(happens([&] { return device.buttons() == 0b001 && seen == 0b001; }));
  stick.pressed = 0;
  EXPECT_TRUE(happens([&] { return device.buttons() == 0 && seen == 0; }));
}

TEST_F(Plugged, ADeviceThatIsUnpluggedIsLostUntilItIsBack) {
  Device device("ff");
  EXPECT_TRUE(happens([&] {
    device.push(half_a_newton());
    return spidar::test::evdev_levels(0).right > 0;
  }));
  stick.pressed = 0b010;
  EXPECT_TRUE(happens([&] { return device.buttons() != 0; }));
  spidar::test::unplug_evdev(0);
  EXPECT_TRUE(happens([&] { return device.state() == DeviceState::kLost; }));
  EXPECT_FALSE(device.push(half_a_newton()));
  EXPECT_EQ(device.felt().force_N.x, 0);
  EXPECT_EQ(device.buttons(), 0u);
  EXPECT_FALSE(device.last_fault().empty());
  EXPECT_FALSE(device.wait_until_running(1ms));
  spidar::test::plug_evdev(0, EvdevKind::kStick);
  EXPECT_TRUE(device.wait_until_running(60s)) << device.last_fault();
  EXPECT_TRUE(happens([&] {
    device.push(half_a_newton());
    return spidar::test::evdev_levels(0).right > 0;
  }));
}

TEST_F(Plugged, ALostDeviceIsAnErrorInC) {
  GstSpidarError error;
  GstSpidarDevice* const device = gst_spidar_device_open("ff", nullptr, &error);
  ASSERT_NE(device, nullptr) << error.message;
  const GstSpidarWrench wrench{{0.5, 0, 0}, {0, 0, 0}};
  spidar::test::unplug_evdev(0);
  EXPECT_TRUE(happens([&] { return !gst_spidar_device_push(device, &wrench, &error); }));
  EXPECT_EQ(error.kind, GST_SPIDAR_ERROR_LOST);
  EXPECT_EQ(std::strncmp(error.message, "the device takes no wrench at present: ", 39), 0)
      << error.message;
  gst_spidar_device_close(device);
  EXPECT_EQ(gst_spidar_device_open("ff", nullptr, &error), nullptr);
  EXPECT_EQ(error.kind, GST_SPIDAR_ERROR_FAILED);
}

TEST_F(Plugged, ClosingWhilePushingLeavesNoForce) {
  {
    Device device("ff");
    device.set_callback([](const GripState&) { return half_a_newton(); }, Energy::kAny);
    EXPECT_TRUE(happens([&] { return spidar::test::evdev_levels(0).right > 0; }));
  }
  EXPECT_TRUE(spidar::test::evdev_levels(0).at_rest());
}

}  // namespace
}  // namespace gst_spidar
