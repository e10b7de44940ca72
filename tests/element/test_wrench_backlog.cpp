// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Wrenches that wait until the haptic loop has room for them.
#include "plugin/timing/loop_queue.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::wrench_schedule_test {
namespace {

constexpr int64_t kFrame = 40 * kMs;

struct Schedule : testing::Test {
  Schedule() {
    schedule.connect(driver.loop.get());
    driver.open();
  }
  ~Schedule() override { schedule.connect(nullptr); }

  void add(int64_t n) {
    schedule.add({n * kFrame, kFrame, push_right(0.001 * static_cast<double>(n % 1000))});
  }
  /// The frame that is felt at the time of each frame from `first` to before `last`.
  void expect_frames(int64_t first, int64_t last) {
    driver.play((first - 1) * kFrame);
    for (int64_t n = first; n < last; ++n) {
      schedule.forward_waiting();
      const TickRecord record = driver.tick(kFrame);
      ASSERT_EQ(record.frame_ns, n * kFrame);
      ASSERT_EQ(record.wanted.force_N.x(), 0.001 * static_cast<double>(n % 1000));
    }
  }

  LoopDriver driver;
  WrenchBacklog schedule;
};

TEST_F(Schedule, KeepsWhatTheLoopHasNoRoomFor) {
  constexpr int64_t kFrames = 5000;
  for (int64_t n = 0; n < kFrames; ++n) add(n);
  expect_frames(0, kFrames);
  EXPECT_EQ(schedule.refused(), 0u);
}

TEST_F(Schedule, ForgetsWaitingWrenchesToo) {
  for (int64_t n = 0; n < 5000; ++n) add(n);
  schedule.clear();
  for (int64_t n = 0; n < 5; ++n) add(100 * n);
  driver.play(0);
  schedule.forward_waiting();
  driver.tick();
  schedule.forward_waiting();
  for (int64_t n = 1; n < 5; ++n) EXPECT_EQ(driver.run(100 * kFrame).frame_ns / kFrame, 100 * n);
}

TEST_F(Schedule, AChangeOfTheRateMovesWhatWaits) {
  for (int64_t n = 0; n < 2000; ++n) add(n);
  schedule.change_rate(2, 0, 0);
  driver.play(-kFrame);
  driver.tick(kFrame / 2);  // what was scheduled for the old rate leaves the loop's ring
  for (int64_t n = 0; n < 2000; ++n) {
    schedule.forward_waiting();
    ASSERT_EQ(driver.tick(kFrame / 2).frame_ns, n * kFrame / 2);
  }
}

TEST_F(Schedule, CountsWhatItRefuses) {
  constexpr size_t kRing = 256;
  for (size_t n = 0; n < kRing + WrenchBacklog::kMaxWaiting + 3; ++n) {
    add(static_cast<int64_t>(n));
  }
  EXPECT_EQ(schedule.refused(), 3u);
}

}  // namespace
}  // namespace spidar::test::wrench_schedule_test
