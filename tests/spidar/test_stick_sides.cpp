// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strongly joysticks push, and to which side.
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "spidar/selftest/stick_test.h"
#include "spidar/session/device_factory.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/support/felt_player.h"

namespace spidar::test::stick_sides_test {
namespace {

/// 20 % of 0xFFFF.
constexpr int kGain = 13107;

class StickSides : public testing::Test {
 protected:
  StickSides() { clear_bus(); }
  ~StickSides() override { clear_bus(); }
};

TEST_F(StickSides, AFifthOfTheStrengthIsUsedUnlessMoreIsAskedFor) {
  const auto used = [](EvdevKind kind, const std::string& option) {
    EvdevPort& port = plug_evdev(0, kind);
    const FeltPlayer player("ff:/dev/input/event0" + option);
    player.push(1.5, 0);
    wait_for([&] { return !evdev_levels(0).at_rest(); });
    return std::pair(port.gain.load(), player.session->grip().description());
  };
  const std::string two = ", force feedback on two axes";
  const std::string one = ", force feedback on one axis: forces up and down are not felt";
  EXPECT_EQ(used(EvdevKind::kStick, ""),
            std::pair(kGain, "Emulated Stick at 20 % of its strength" + two));
  EXPECT_EQ(used(EvdevKind::kWheel, ""),
            std::pair(kGain, "Emulated Racing Wheel at 20 % of its strength" + one));
  EXPECT_EQ(used(EvdevKind::kStick, ",gain=60"),
            std::pair(39321, "Emulated Stick at 60 % of its strength" + two));
  EXPECT_EQ(used(EvdevKind::kStick, ",axes=1,gain=100"), std::pair(0xFFFF, "Emulated Stick" + one));
  EXPECT_EQ(used(EvdevKind::kPad, "").first, 0);
  // A driver without gain: levels.
  plug_evdev(0, EvdevKind::kOneAxis);
  const FeltPlayer player;
  player.push(1.5, 0);
  wait_for([] { return is_level(evdev_levels(0).right, 0.3, 0.3); });
}

/// A stick without a hand, by a thread of its own: the position follows the level, or its opposite.
class MovingStick {
 public:
  MovingStick(size_t number, int right, int up)
      : thread_([this, number, right, up] {
          EvdevPort& port = bus().evdev[number];
          while (!stop_) {
            const EvdevLevels levels = evdev_levels(number);
            port.axis[0] = right * levels.right / 100;
            port.axis[1] = -up * levels.up / 100;  // y of a stick points down
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}
  ~MovingStick() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

StickTest tested(size_t number, const char* option, int right, int up) {
  const MovingStick stick(number, right, up);
  BoardSettings settings;
  settings.guardian = false;
  settings.threaded = false;  // a thread may get no processor for 20 exchanges
  const auto grip = make_grip("ff:/dev/input/event" + std::to_string(number) + option,
                              load_profile(kDefaultProfile), settings);
  const auto pace = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return true;
  };
  return test_stick(*grip, pace, grip->abilities().largest_force_N / 2);
}

// A test takes five seconds in real time, so all sticks are tested at once.
TEST_F(StickSides, ADriverThatPushesToTheOtherSideIsFound) {
  struct Stick {
    const char* option;
    int right, up;              ///< to which side the driver pushes
    int found_right, found_up;  ///< with the option
  };
  constexpr std::array<Stick, kEvdevPorts> kSticks{{{"", 1, 1, 1, 1},
                                                    {"", -1, 1, -1, 1},
                                                    {"", 1, -1, 1, -1},
                                                    {"", 0, 0, 0, 0},
                                                    // With the option that mends it.
                                                    {",flip=x", -1, 1, 1, 1},
                                                    {",flip=xy", -1, -1, 1, 1}}};
  std::array<std::future<StickTest>, kSticks.size()> tests;
  for (size_t i = 0; i < kSticks.size(); ++i) plug_evdev(i, EvdevKind::kStick);
  for (size_t i = 0; i < kSticks.size(); ++i)
    tests[i] = std::async(std::launch::async, tested, i, kSticks[i].option, kSticks[i].right,
                          kSticks[i].up);
  const auto side = [](double m) {
    return (m >= StickTest::kLeast_m) - (m <= -StickTest::kLeast_m);
  };
  for (size_t i = 0; i < kSticks.size(); ++i) {
    SCOPED_TRACE(i);
    const StickTest test = tests[i].get();
    EXPECT_TRUE(test.complete);
    EXPECT_EQ(side(test.moved_m[0]), kSticks[i].found_right);
    EXPECT_EQ(side(test.moved_m[1]), kSticks[i].found_up);
  }
}

}  // namespace
}  // namespace spidar::test::stick_sides_test
