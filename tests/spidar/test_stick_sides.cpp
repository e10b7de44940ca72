// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strongly joysticks push, to which side, and whether a spring pulls them back.
#include <future>
#include <variant>

#include "core/grip/string_geometry.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/selftest/stick_test.h"
#include "spidar/session/device_factory.h"
#include "tests/spidar/bus_test.h"
#include "tests/spidar/force_bench.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::stick_sides_test {
namespace {

/// 20 % of 0xFFFF.
constexpr int kGain = 13107;

class StickSides : public BusTest {};

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

/// A stick without a hand and with much friction: its speed follows the level, or its opposite, and
/// a centring spring. By a thread of its own.
class MovingStick {
 public:
  MovingStick(size_t number, int right, int up)
      : thread_([this, number, right, up] {
          EvdevPort& port = bus().evdev[number];
          // Half of the level moves it by three tenths of its way in a push of 0.2 s.
          constexpr double kSpeed_s = 2 * 0.3 / 0.2 / ff::kFullLevel, kSpring_s = 3;
          std::array<double, 2> at{};  // of the way to the edge
          for (int64_t last_ns = monotonic_now_ns(); !stop_;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const int64_t now_ns = monotonic_now_ns();
            const double dt_s = 1e-9 * static_cast<double>(now_ns - std::exchange(last_ns, now_ns));
            const EvdevLevels levels = evdev_levels(number);
            const std::array<int, 2> level{right * levels.right, -up * levels.up};  // y points down
            const bool springs = port.keeps_spring || port.autocentre > 0;
            for (size_t axis = 0; axis < at.size(); ++axis) {
              at[axis] += dt_s * kSpeed_s * level[axis];
              if (springs) at[axis] *= std::exp(-kSpring_s * dt_s);
              at[axis] = std::clamp(at[axis], -1.0, 1.0);
              port.axis[axis] = static_cast<int>(std::lround(1000 * at[axis]));
            }
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

selftest::StickTest tested(size_t number, const char* option, int right, int up) {
  const MovingStick stick(number, right, up);
  // Without a thread, which may get no processor for 20 exchanges.
  const auto grip = make_grip("ff:/dev/input/event" + std::to_string(number) + option,
                              load_profile(kDefaultProfile), unguarded());
  const auto pace = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return true;
  };
  return selftest::test_stick(*grip, pace, grip->abilities().largest_force_N / 2);
}

// A test takes six seconds in real time, so all sticks are tested at once.
TEST_F(StickSides, ADriverThatPushesToTheOtherSideIsFound) {
  struct Stick {
    const char* option;
    int right, up;              ///< to which side the driver pushes
    int found_right, found_up;  ///< with the option
    bool keeps_spring = false;
  };
  constexpr std::array<Stick, kEvdevPorts> kSticks{{{"", 1, 1, 1, 1},
                                                    {"", -1, 1, -1, 1, true},
                                                    {"", 1, -1, 1, -1},
                                                    {"", 0, 0, 0, 0, true},
                                                    // With the option that mends it.
                                                    {",flip=x", -1, 1, 1, 1},
                                                    {",flip=xy", -1, -1, 1, 1, true}}};
  std::array<std::future<selftest::StickTest>, kSticks.size()> tests;
  for (size_t i = 0; i < kSticks.size(); ++i)
    // A driver that turns the centring spring on, until it is told to switch it off.
    plug_evdev(i, EvdevKind::kStick, "hid-generic").keeps_spring = kSticks[i].keeps_spring;
  for (size_t i = 0; i < kSticks.size(); ++i)
    tests[i] = std::async(std::launch::async, tested, i, kSticks[i].option, kSticks[i].right,
                          kSticks[i].up);
  const auto side = [](double m) {
    return (m >= selftest::StickTest::kMin_m) - (m <= -selftest::StickTest::kMin_m);
  };
  for (size_t i = 0; i < kSticks.size(); ++i) {
    SCOPED_TRACE(i);
    const selftest::StickTest test = tests[i].get();
    EXPECT_TRUE(test.complete);
    EXPECT_EQ(side(test.moved_m[0]), kSticks[i].found_right);
    EXPECT_EQ(side(test.moved_m[1]), kSticks[i].found_up);
    for (const size_t axis : {0, 1})
      EXPECT_EQ(test.spring[axis] > 0, kSticks[i].keeps_spring && kSticks[i].right != 0);
  }
}

/// In the time of the exchanges, one a millisecond.
class SteppedStick final : public emulated::Motors {
 public:
  /// Half of the level moves it by three tenths of its way in 0.2 s.
  static constexpr double kSpeed_s = 2 * 0.3 / 0.2;

  /// `spring_s`: spring over friction, in 1/s; `inertia_s`: how long its speed needs to follow.
  SteppedStick(double spring_s, double inertia_s) : spring_s_(spring_s), inertia_s_(inertia_s) {}
  void set_outputs(const std::array<int, kMaxStrings>& levels) noexcept override {
    force_ = double{1} * levels[0] / ff::kFullLevel;
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override {
    return {static_cast<int32_t>(std::lround(ff::Position::kFull * at_))};
  }
  void pass(double dt_s) {
    const double wanted_s = kSpeed_s * force_ - spring_s_ * at_;
    speed_s_ += inertia_s_ > 0 ? (wanted_s - speed_s_) * dt_s / inertia_s_ : wanted_s - speed_s_;
    at_ += dt_s * speed_s_;
  }

 private:
  const double spring_s_, inertia_s_;
  double force_ = 0, at_ = 0, speed_s_ = 0;
};

/// How a stick answers along x, and where it is when it is pushed all the way.
std::pair<selftest::StickTest, double> stepped_test(double spring_s, double inertia_s) {
  ForceBench bench("ff");
  const auto stick = std::make_shared<SteppedStick>(spring_s, inertia_s);
  boards::ForceGrip grip(std::make_unique<boards::ForceLink>(
      std::get<std::unique_ptr<boards::ForceBoard>>(bench.kind.attach(
          bench.kind.board, bench.profile, wire_to(bench.kind.emulate(stick), bench.wire))),
      ForceBench::settings(false)));
  const auto pace = [&] {
    stick->pass(kTick_s);
    return true;
  };
  const selftest::StickTest test =
      selftest::test_stick(grip, pace, grip.abilities().largest_force_N / 2);
  return {test, half_picture_m(bench.profile.geometry).x()};
}

TEST(StickSpring, IsMeasuredAgainstThePush) {
  for (const double spring_s : {0.02, 0.5, 1.0, 3.0, 10.0, 50.0}) {
    SCOPED_TRACE(spring_s);
    const selftest::StickTest test = stepped_test(spring_s, 0).first;
    // A push of 0.22 s, in which ramps count half, moves it to this fraction of the place where the
    // spring balances the push.
    const double true_spring = 1 - std::exp(-spring_s * 0.22);
    if (true_spring < test.least_spring[0])
      EXPECT_EQ(test.spring[0], 0);
    else
      EXPECT_NEAR(test.spring[0], true_spring, 0.05);
    // Steps back of 0.5 mm, from 14 mm at most.
    EXPECT_GT(test.least_spring[0], 0.02);
    EXPECT_LT(test.least_spring[0], 0.05 + 0.3 * true_spring);
  }
}

TEST(StickSpring, IsNoneOnAStickThatMovesOn) {
  for (const double inertia_s : {0.0, 0.05, 0.2}) {
    const auto [test, reach_m] = stepped_test(0, inertia_s);
    EXPECT_GT(test.moved_m[0], 0.1 * reach_m) << inertia_s;
    EXPECT_EQ(test.spring[0], 0) << inertia_s;
  }
}

constexpr const char* kStays = ", and stays there: no spring of more than ";

std::string report(const selftest::StickTest& test, const std::string& device,
                   bool two_axes = true) {
  GripAbilities can;
  can.force = {true, two_axes, false};
  return selftest::stick_report(test, can, {0.03, 0.03}, device);
}

TEST(StickReport, SaysWhatWasFoundAndWhatToDo) {
  selftest::StickTest test;
  test.moved_m = {0.012, -0.006, 0};
  test.least_spring = {0.03, 0.06, 0};
  test.spring = {0, 0.61, 0};
  const std::string text = report(test, "ff:/dev/input/event5");
  expect_contains(text, std::string("right    moves with the force, by 40 % of its way") + kStays +
                            "3 % of the push\n");
  expect_contains(
      text,
      "up       moves against the force, by 20 % of its way; a spring pulls it back with "
      "61 % of the push\n");
  expect_contains(text, "Write flip=y: device=ff:PATH,flip=y\n");
  expect_contains(text, "spring of metal or of the device's firmware");
  EXPECT_EQ(text.find("does not move"), std::string::npos);
  // What is turned round already.
  expect_contains(report(test, "ff:/dev/input/event5,flip=x,gain=30"), "Write flip=xy: ");
  expect_contains(report(test, "ff:/dev/input/event5,gain=30,flip=y"), "Write no flip=y\n");

  const std::string still = report({}, "ff", false);
  EXPECT_EQ(still.find("up  "), std::string::npos) << still;
  expect_contains(still, "right    does not move: no force arrives, or ");
  expect_contains(still, "ff:PATH,gain=50");
  expect_contains(still, "fftest");
  test.moved_m = {0.012, 0.006, 0};
  test.spring = {};
  EXPECT_EQ(report(test, "ff"), std::string("right    moves with the force, by 40 % of its way") +
                                    kStays +
                                    "3 % of the push\n"
                                    "up       moves with the force, by 20 % of its way" +
                                    kStays + "6 % of the push\n");
}

}  // namespace
}  // namespace spidar::test::stick_sides_test
