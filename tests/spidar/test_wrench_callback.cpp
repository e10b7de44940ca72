// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The function of an application that the loop asks for a wrench: when it is asked, what stops it.
// That a wall of it gives a hand no energy is in test_touch_strings.cpp.
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"

namespace spidar::test::wrench_callback_test {
namespace {

using State = WrenchCallback::State;

constexpr bool kAnyEnergy = false;  // it is not passive

TEST(WrenchCallback, IsAskedInEveryTickAndFelt) {
  LoopDriver driver;
  driver.open();
  int calls = 0;
  double dt_s = 0;
  driver.loop->callback().set(
      [&](const CallbackInput& input) {
        ++calls;
        dt_s = input.dt_s;
        return push_right(1);
      },
      kAnyEnergy);
  EXPECT_EQ(driver.loop->callback().state(), State::kRuns);
  const TickRecord last = driver.run(100 * kMs);
  EXPECT_EQ(calls, 100);
  EXPECT_DOUBLE_EQ(dt_s, 1e-3);
  EXPECT_EQ(last.wanted.force_N, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(last.commanded.force_N, Eigen::Vector3d(1, 0, 0));
  // Beside a film, it is added.
  driver.play(0);
  driver.loop->schedule({10 * kMs, 1000 * kMs, push_right(0.5)});
  EXPECT_DOUBLE_EQ(driver.run(100 * kMs).wanted.force_N.x(), 1.5);
  driver.pause();
  driver.run(100 * kMs);
  driver.loop->callback().set({});
  EXPECT_EQ(driver.loop->callback().state(), State::kNone);
  EXPECT_TRUE(driver.run(100 * kMs).commanded.force_N.isZero());
}

TEST(WrenchCallback, IsNotAskedWhileTheLoopCloses) {
  LoopDriver driver;
  driver.open();
  int calls = 0;
  driver.loop->callback().set(
      [&](const CallbackInput&) {
        ++calls;
        return push_right(1);
      },
      kAnyEnergy);
  driver.run(50 * kMs);
  driver.loop->begin_close();
  driver.run(100 * kMs);
  EXPECT_EQ(calls, 50);
  EXPECT_TRUE(driver.loop->released());
}

TEST(WrenchCallback, OneThatThrowsIsNotCalledAgain) {
  LoopDriver driver;
  driver.open();
  int calls = 0;
  const auto throws = [&](const CallbackInput&) -> Wrench {
    if (++calls == 3) throw std::runtime_error("division by zebra " + std::string(300, 'z'));
    return push_right(1);
  };
  driver.loop->callback().set(throws, kAnyEnergy);
  EXPECT_TRUE(driver.run(200 * kMs).commanded.force_N.isZero());
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(driver.loop->callback().state(), State::kThrew);
  EXPECT_EQ(std::string(driver.loop->callback().thrown()).find("division by zebra"), 0u);
  driver.loop->callback().set([](const CallbackInput&) -> Wrench { throw 3; }, kAnyEnergy);
  driver.tick();
  EXPECT_EQ(driver.loop->callback().state(), State::kThrew);
  EXPECT_STREQ(driver.loop->callback().thrown(), "");
}

TEST(WrenchCallback, OneThatIsLateAgainAndAgainIsNotCalledAgain) {
  LoopDriver driver;
  driver.open();
  int calls = 0;
  driver.loop->callback().set(
      [&](const CallbackInput&) {
        ++calls;
        std::this_thread::sleep_for(std::chrono::nanoseconds(WrenchCallback::kLongest_ns));
        return push_right(1);
      },
      kAnyEnergy);
  driver.run(100 * kMs);
  EXPECT_EQ(calls, WrenchCallback::kSlowInARow);
  EXPECT_EQ(driver.loop->callback().state(), State::kTooSlow);
}

TEST(WrenchCallback, WhatIsNotFiniteIsRefused) {
  LoopDriver driver;
  driver.open();
  for (const bool passive : {false, true}) {
    driver.loop->callback().set(
        [](const CallbackInput&) { return push_right(std::numeric_limits<double>::quiet_NaN()); },
        passive, 0.002);
    const uint64_t before = driver.counters().rejected_wrenches;
    EXPECT_TRUE(driver.run(10 * kMs).commanded.force_N.isZero());
    EXPECT_EQ(driver.counters().rejected_wrenches - before, 10u);
  }
}

/// When set() returns, what the function before refers to may go.
TEST(WrenchCallback, TheOneBeforeHasEndedWhenItIsReplaced) {
  LoopDriver driver;
  driver.open();
  std::atomic<bool> ends{false};
  std::atomic<int> calls{0};
  std::thread ticks([&] {
    while (!ends) driver.tick();
  });
  for (int i = 0; i < 200; ++i) {
    auto alive = std::make_unique<std::atomic<bool>>(true);
    std::atomic<bool>* const seen = alive.get();
    const int before = calls;
    driver.loop->callback().set(
        [&calls, seen](const CallbackInput&) {
          EXPECT_TRUE(*seen);
          ++calls;
          EXPECT_TRUE(*seen);
          return Wrench{};
        },
        kAnyEnergy);
    while (calls == before) std::this_thread::yield();
    driver.loop->callback().set({});
    *alive = false;
  }
  ends = true;
  ticks.join();
}

}  // namespace
}  // namespace spidar::test::wrench_callback_test
