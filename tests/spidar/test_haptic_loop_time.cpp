// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which frame is felt when the times of frames are unusual.
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::haptic_loop_time_test {
namespace {

constexpr int64_t kHold = 100 * kMs;

TEST(HapticLoopTime, OfAThousandFramesASecondNoneIsMissed) {
  LoopDriver driver;
  driver.open();
  for (int i = 0; i < 200; ++i) driver.loop->schedule({i * kMs, kHold, push_right(0.01 * i)});
  driver.play(0);
  for (int i = 1; i < 200; ++i) {
    const TickRecord record = driver.tick();
    ASSERT_EQ(record.frame_ns, i * kMs);
    ASSERT_EQ(record.found, Found::kExact) << "frame " << i;
    ASSERT_EQ(record.wanted.force_N.x(), 0.01 * i) << "frame " << i;
  }
}

/// The line that the loop has, refreshed every 10 ms with `running_ns` of the time since it began.
template <typename Running>
void play_for(LoopDriver& driver, TickWatch& watch, int64_t duration_ns, Running running_ns) {
  const int64_t begin_ns = driver.now_ns;
  for (int64_t since_ns = 0; since_ns < duration_ns; since_ns += kTick_ns) {
    if (since_ns % (10 * kMs) == 0) {
      PlaybackClock clock{driver.now_ns, running_ns(since_ns), 1.0, true};
      clock.valid_until_ns = begin_ns + kHold;
      driver.loop->set_playback_clock(clock);
    }
    driver.now_ns += kTick_ns;
    watch.tick(*driver.loop, driver.now_ns);
  }
}

TEST(HapticLoopTime, AnOutdatedClockIsNotFollowed) {
  LoopDriver driver;
  driver.open();
  for (int i = 0; i < 100; ++i) driver.loop->schedule({i * 40 * kMs, kHold, push_right(2)});
  TickWatch watch;
  // Goes on by itself and is set back, as by a clock that stands still.
  play_for(driver, watch, 6000 * kMs, [](int64_t) { return 75 * kMs; });
  EXPECT_GT(watch.felt(), 100u);
  EXPECT_LT(watch.felt(), 150u);
  EXPECT_FALSE(watch.last().playing);
}

TEST(HapticLoopTime, AGapWhoseEndIsKnownIsRest) {
  LoopDriver driver;
  driver.open();
  constexpr int64_t kGapEnd = 8000 * kMs;
  for (int i = 0; i < 5; ++i) driver.loop->schedule({i * 40 * kMs, 50 * kMs, push_right(2)});
  driver.loop->schedule({kGapEnd, 50 * kMs, push_right(-2)});
  driver.play(0);
  TickWatch watch;
  const auto play_to = [&](int64_t running_ns) {
    while (watch.last().running_ns < running_ns)
      watch.tick(*driver.loop, driver.now_ns += kTick_ns);
    return watch.last().commanded.force_N.x();
  };
  EXPECT_EQ(play_to(160 * kMs), 2);
  EXPECT_EQ(play_to(160 * kMs + 100 * kMs), 0);
  const uint64_t felt_before = watch.felt();
  EXPECT_EQ(play_to(kGapEnd - 41 * kMs), 0);
  EXPECT_EQ(watch.felt(), felt_before);
  EXPECT_EQ(play_to(kGapEnd), -2) << "there in time";
}

}  // namespace
}  // namespace spidar::test::haptic_loop_time_test
