// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The interface of libgst-spidar, linked in the same way as by other programs.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <gst-spidar/device.h>
#include <gtest/gtest.h>

namespace gst_spidar {
namespace {

using namespace std::chrono_literals;

// A change here changes the binary interface and needs a new soname, as removing a symbol does.
static_assert(sizeof(Vector3) == 3 * sizeof(double));
static_assert(sizeof(Quaternion) == 4 * sizeof(double));
static_assert(sizeof(Wrench) == 2 * sizeof(Vector3));
static_assert(sizeof(Pose) == sizeof(Vector3) + sizeof(Quaternion));
static_assert(sizeof(GreyPicture) == 2 * sizeof(void*) + 2 * sizeof(int));
static_assert(sizeof(GripState) == sizeof(Pose) + 2 * sizeof(Vector3) + 2 * sizeof(double));
static_assert(sizeof(Capabilities) == 9 * sizeof(double));
static_assert(sizeof(Surface) == sizeof(GreyPicture) + 4 * sizeof(double));
static_assert(sizeof(Device) == sizeof(void*));
static_assert(std::is_nothrow_move_constructible_v<Device> &&
              !std::is_copy_constructible_v<Device>);
static_assert(static_cast<int>(DeviceState::kLost) == 3);

/// Events that take milliseconds; the limit is generous for a busy machine.
bool comes_true(const std::function<bool()>& what) {
  const auto until = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < until) {
    if (what()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

Wrench to_the_right(double newtons) {
  Wrench wrench;
  wrench.force_N.x = newtons;
  return wrench;
}

std::string message_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

TEST(Device, WhatIsFeltIsKnownWhileTheTensionsRampUp) {
  // Opening takes a few tenths of a second. A busy machine may sleep through it, so open again
  // then.
  EXPECT_TRUE(comes_true([] {
    Device device("sim");
    while (device.state() == DeviceState::kOpening) {
      device.push(to_the_right(1));
      const double felt_N = device.felt().force_N.x;
      // Still opening afterwards, so it was opening when felt() was read.
      if (device.state() == DeviceState::kOpening && felt_N > 0.1) return true;
    }
    return false;
  }));
}

TEST(Device, AWrenchThatIsNotRenewedRunsOut) {
  Device device("sim");
  ASSERT_TRUE(comes_true([&] {
    device.push(to_the_right(1));
    return device.felt().force_N.x > 0.5;
  }));
  EXPECT_TRUE(comes_true([&] { return std::abs(device.felt().force_N.x) < 0.01; }));
}

TEST(Device, LimitsHold) {
  Device device("sim");
  device.set_limits(0.5, 0);
  ASSERT_TRUE(comes_true([&] {
    device.push(to_the_right(2));
    return device.felt().force_N.x > 0.49;
  }));
  for (int i = 0; i < 50; ++i) {
    device.push(to_the_right(2));
    std::this_thread::sleep_for(1ms);
    EXPECT_LT(device.felt().force_N.x, 0.51);
  }
}

TEST(Device, ACallbackIsFelt) {
  std::atomic<double> last_s{0};
  Device device("sim");
  ASSERT_TRUE(device.wait_until_running(60s));
  EXPECT_EQ(device.last_fault(), "");
  device.set_callback(
      [&](const GripState& grip) {
        last_s = grip.interval_s;
        return to_the_right(1);
      },
      Energy::kAny);
  EXPECT_TRUE(comes_true([&] { return device.felt().force_N.x > 0.9; }));
  EXPECT_GT(last_s, 0);
  EXPECT_EQ(device.callback_error(), "");
  // By default, it pushes no hand that rests.
  device.set_callback([](const GripState&) { return to_the_right(1); });
  EXPECT_TRUE(comes_true([&] { return std::abs(device.felt().force_N.x) < 0.01; }));
  device.set_callback([](const GripState&) -> Wrench { throw std::range_error("beyond"); });
  EXPECT_TRUE(comes_true([&] { return !device.callback_error().empty(); }));
  EXPECT_EQ(device.callback_error(), "the callback has thrown an exception: beyond");
  device.set_callback({});
  EXPECT_EQ(device.callback_error(), "");
}

/// A picture of 64 × 64 pixels that changes in columns 28 to 44, which is a bit to the right.
class Relief {
 public:
  Relief(int left, int right) {
    for (int i = 0; i < kSide * kSide; ++i)
      pixels_[static_cast<size_t>(i)] =
          static_cast<uint8_t>(left + (right - left) * std::clamp(i % kSide - 28, 0, 16) / 16);
    surface.picture = {pixels_.data(), kSide, kSide, kSide};
  }
  Surface surface;

 private:
  static constexpr int kSide = 64;
  std::vector<uint8_t> pixels_ = std::vector<uint8_t>(size_t{kSide} * kSide);
};

TEST(Device, ASurfaceIsTouched) {
  Device device("sim");
  ASSERT_TRUE(device.wait_until_running(60s));
  // 4 mm in front of the hand, which is at the centre and yields by 1 N / 300 N/m: with 200 N/m,
  // 0.48 N hold it 1.6 mm further out. Strings at rest pull it back by 8 · 0.3 N / 0.1 m at most.
  Relief wall(255, 255);
  wall.surface.friction = 0;  // it would hold the hand where the wall meets it after the hill
  ASSERT_TRUE(device.set_surface(wall.surface));
  EXPECT_TRUE(comes_true([&] { return device.felt().force_N.z > 0.4; }));
  EXPECT_TRUE(comes_true([&] { return device.pose()->position_m.z > 0.0012; }));
  EXPECT_LT(device.felt().force_N.z, 0.004 * 200);
  device.clear_surface();
  EXPECT_TRUE(comes_true([&] { return std::abs(device.felt().force_N.z) < 0.05; }));
  // The slope of a hill pushes to its foot. At the centre, this one is 7.5 mm above the hand.
  Relief hill(255, 0);
  hill.surface.relief_m = 0.03;
  hill.surface.friction = 0;
  ASSERT_TRUE(device.set_surface(hill.surface));
  EXPECT_TRUE(comes_true([&] { return device.felt().force_N.x > 0.1; }));
  // As many as there may be; the loop takes the newest.
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(device.set_surface(wall.surface));
  EXPECT_TRUE(comes_true([&] { return std::abs(device.felt().force_N.x) < 0.05; }));
}

TEST(Device, ASurfaceThatIsWrongIsNamed) {
  Device device("sim");
  const auto message = [&](const std::function<void(Surface&)>& change) {
    Relief relief(0, 255);
    change(relief.surface);
    return message_of([&] { device.set_surface(relief.surface); });
  };
  EXPECT_EQ(message([](Surface&) {}), "");
  EXPECT_EQ(message([](Surface& s) { s.stiffness_N_m = 801; }),
            "the stiffness of a surface must be at most 800 N/m on this device, got 801");
  EXPECT_EQ(message([](Surface& s) { s.relief_m = 0.04; }),
            "the height of a relief must be at most 0.03 m, got 0.04");
  EXPECT_NE(message([](Surface& s) { s.friction = -1; }), "");
  EXPECT_NE(message([](Surface& s) { s.texture = std::nan(""); }), "");
  EXPECT_NE(message([](Surface& s) { s.stiffness_N_m = 0; }), "");
  EXPECT_NE(message([](Surface& s) { s.picture.data = nullptr; }), "");
  EXPECT_NE(message([](Surface& s) { s.picture.height = 15; }), "");
  Device stick("sim:ff");
  EXPECT_EQ(stick.capabilities().workspace_m.z, 0);
  const Relief relief(0, 255);
  EXPECT_NE(message_of([&] { stick.set_surface(relief.surface); }).find("has no surfaces"),
            std::string::npos);
}

TEST(Device, WaitingEndsWhenTheTimeIsOver) {
  const Device device("sim");
  EXPECT_FALSE(device.wait_until_running(0ms));
  EXPECT_TRUE(device.wait_until_running(60s));
}

TEST(Device, WhatItCanDoIsKnown) {
  const Capabilities whole = Device("sim").capabilities();
  EXPECT_TRUE(whole.force_x && whole.force_y && whole.force_z && whole.torque && whole.direction);
  // Those of WhatIsWrongIsNamed; stiffness as far as it was measured at a lag of 2 ms.
  EXPECT_DOUBLE_EQ(whole.largest_force_N, 7.2);
  EXPECT_DOUBLE_EQ(whole.largest_stiffness_N_m, 800);
  EXPECT_GE(whole.largest_torque_Nm, 0.1);
  // Half of the box of the exits of spidar-gcc.
  EXPECT_DOUBLE_EQ(whole.workspace_m.x, 0.059);
  EXPECT_DOUBLE_EQ(whole.workspace_m.y, 0.064);
  EXPECT_GT(whole.workspace_m.z, 0.02);
  EXPECT_EQ(whole.rate_Hz, 1000);
  const Capabilities desktop = Device("sim:inverse3").capabilities();
  EXPECT_TRUE(desktop.force_x && desktop.force_y && desktop.force_z && desktop.direction);
  EXPECT_FALSE(desktop.torque);
  EXPECT_DOUBLE_EQ(desktop.largest_force_N, 10);
  EXPECT_DOUBLE_EQ(desktop.workspace_m.x, 0.14);
  EXPECT_DOUBLE_EQ(desktop.workspace_m.z, 0.14);
  EXPECT_EQ(desktop.buttons, 3);
  const Capabilities falcon = Device("sim:falcon").capabilities();
  EXPECT_DOUBLE_EQ(falcon.largest_force_N, 4.4);
  EXPECT_DOUBLE_EQ(falcon.workspace_m.x, 0.07);
  EXPECT_EQ(falcon.buttons, 4);
  const Capabilities stick = Device("sim:ff").capabilities();
  EXPECT_TRUE(stick.force_x && stick.force_y && stick.direction);
  EXPECT_FALSE(stick.force_z || stick.torque);
}

TEST(Device, MovesToAnotherObject) {
  Device first("sim");
  Device second = std::move(first);
  EXPECT_EQ(second.name(), "sim");
  first = Device("sim:sh4");
  EXPECT_EQ(first.name(), "sim:sh4");
}

TEST(Device, WhatIsWrongIsNamed) {
  EXPECT_NE(message_of([] { Device("nosuch"); }).find("unknown device \"nosuch\""),
            std::string::npos);
  EXPECT_NE(message_of([] { Device("sim", "nosuch"); }).find("unknown profile \"nosuch\""),
            std::string::npos);
  EXPECT_EQ(message_of([] { Device("none"); }), "\"none\" cannot be opened");
  EXPECT_THROW(Device("uart:/nosuch"), std::runtime_error);
  Device device("sim");
  EXPECT_THROW(device.push(to_the_right(std::nan(""))), std::invalid_argument);
  EXPECT_THROW(device.set_limits(-1, 0), std::invalid_argument);
  // Eight strings of 4.2 N on spidar-gcc give 7.29 N in the weakest direction.
  EXPECT_NO_THROW(device.set_limits(7.2, 0.1));
  EXPECT_EQ(message_of([&] { device.set_limits(7.3, 0.1); }),
            "the largest force must be 0 to 7.2 N, which spidar-gcc can give in every direction "
            "without throwing a grip that is let go, got 7.3");
  EXPECT_THROW(device.set_limits(1e9, 0.1), std::invalid_argument);
  const double most_Nm = device.capabilities().largest_torque_Nm;
  EXPECT_NO_THROW(device.set_limits(3, most_Nm));
  EXPECT_NE(message_of([&] { device.set_limits(3, most_Nm + 0.001); }).find("the largest torque"),
            std::string::npos);
  EXPECT_THROW(device.set_limits(1, std::numeric_limits<double>::infinity()),
               std::invalid_argument);
}

TEST(Device, ANameThatCWouldCutIsRefused) {
  EXPECT_THROW(gst_spidar::Device(std::string("sim\0x", 5)), std::invalid_argument);
  EXPECT_THROW(gst_spidar::Device("sim", std::string("spidar-g\0x", 10)), std::invalid_argument);
}

TEST(Device, NamesAreListed) {
  bool has_sim = false;
  for (const std::string& name : list_devices()) has_sim |= name == "sim";
  EXPECT_TRUE(has_sim);
  for (const std::string& name : list_profiles()) EXPECT_NO_THROW(Device("sim", name)) << name;
}

}  // namespace
}  // namespace gst_spidar
