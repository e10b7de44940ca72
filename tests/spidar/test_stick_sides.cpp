// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strongly joysticks push, and to which side.
#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "spidar/session/device_factory.h"
#include "spidar/wiring/stick_test.h"
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
  MovingStick(EvdevPort& port, int right, int up)
      : thread_([this, &port, right, up] {
          while (!stop_) {
            const EvdevLevels levels = evdev_levels(0);
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

TEST_F(StickSides, ADriverThatPushesToTheOtherSideIsFound) {
  const auto moved_m = [](const std::string& spec, int right, int up) {
    EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
    const MovingStick stick(port, right, up);
    BoardSettings settings;
    settings.guardian = false;
    settings.threaded = false;  // a thread may get no processor for 20 exchanges
    const auto grip = make_grip(spec, load_profile(kDefaultProfile), settings);
    const auto pace = [] {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return true;
    };
    const StickTest test = test_stick(*grip, pace, grip->abilities().largest_force_N / 2);
    EXPECT_TRUE(test.complete);
    return test.moved_m;
  };
  const auto side = [](double m) {
    return (m >= StickTest::kLeast_m) - (m <= -StickTest::kLeast_m);
  };
  const std::string spec = "ff:/dev/input/event0";
  for (const auto& [option, right, up] :
       {std::tuple{"", 1, 1}, {"", -1, 1}, {"", 1, -1}, {"", 0, 0}}) {
    const std::array<double, 3> found_m = moved_m(spec + option, right, up);
    EXPECT_EQ(side(found_m[0]), right);
    EXPECT_EQ(side(found_m[1]), up);
  }
  // With the option that mends it.
  EXPECT_GT(moved_m(spec + ",flip=x", -1, 1)[0], StickTest::kLeast_m);
  EXPECT_GT(moved_m(spec + ",flip=xy", -1, -1)[1], StickTest::kLeast_m);
}

}  // namespace
}  // namespace spidar::test::stick_sides_test
