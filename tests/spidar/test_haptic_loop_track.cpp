// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force of a track's samples in the haptic loop.
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::haptic_loop_track_test {
namespace {

float fraction_at(int64_t ms) {
  return 0.2F * static_cast<float>(std::sin(0.02 * static_cast<double>(ms)));
}

TrackBlock block_of(int64_t begin_ms, size_t count = TrackBlock::kCapacity) {
  TrackBlock block;
  block.begin_ns = begin_ms * kMs;
  block.count = count;
  block.duration_ns = static_cast<int64_t>(count) * kMs;
  for (size_t i = 0; i < count; ++i) {
    const float fraction = fraction_at(begin_ms + static_cast<int64_t>(i));
    block.samples[i] = {fraction, -fraction, 0, 0, fraction / 10, 0};
  }
  return block;
}

struct TrackDriver : LoopDriver {
  TrackDriver() { open(); }

  TickRecord watched_tick() {
    now_ns += kMs;
    return watch.tick(*loop, now_ns);
  }
  TickRecord watched_run(int ticks) {
    TickRecord record;
    for (int i = 0; i < ticks; ++i) record = watched_tick();
    return record;
  }
  void schedule(int64_t from_ms, int64_t to_ms) {
    for (int64_t ms = from_ms; ms < to_ms; ms += TrackBlock::kCapacity) {
      ASSERT_TRUE(loop->schedule(block_of(ms)));
    }
  }

  TickWatch watch;
};

TEST(HapticLoopTrack, AFlushForgetsSamplesAlsoThoseOfABlockThatIsBeingRead) {
  TrackDriver driver;
  driver.schedule(0, 2000);
  driver.play(0);
  driver.watched_run(100);
  driver.loop->cancel_scheduled();
  EXPECT_EQ(driver.watched_tick().found, Found::kNothing);
  driver.schedule(1000, 1400);
  driver.play(1000 * kMs);
  const TickRecord record = driver.watched_run(90);
  EXPECT_EQ(record.found, Found::kExact);
  EXPECT_EQ(record.wanted.force_N.x(), kTrackForceScale_N * fraction_at(1090));
}

TEST(HapticLoopTrack, AFlushMakesRoomAlsoWhileNothingPlays) {
  TrackDriver driver;
  int blocks = 0;
  while (driver.loop->schedule(block_of(40 * blocks))) ++blocks;
  EXPECT_GE(blocks, 60) << "two seconds and more of a track fit";
  driver.loop->cancel_scheduled();
  driver.watched_tick();
  EXPECT_TRUE(driver.loop->schedule(block_of(0)));
}

TEST(HapticLoopTrack, NoSampleHoweverBadBreaksALimit) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float huge = std::numeric_limits<float>::max();
  TrackDriver driver;
  driver.play(0);
  int64_t ms = 0;
  for (const float bad : {inf, -inf, nan, huge, -huge}) {
    for (const size_t count : {size_t{1}, size_t{3}, TrackBlock::kCapacity}) {
      TrackBlock block = block_of(ms, count);
      for (size_t i = 0; i < count; i += 2) block.samples[i][i % kTrackChannels] = bad;
      ASSERT_TRUE(driver.loop->schedule(block));
      ms += static_cast<int64_t>(count);
    }
  }
  // The watch fails the test where a limit of force, torque or their change is broken.
  driver.watched_run(static_cast<int>(ms) + 60);
  EXPECT_EQ(driver.watch.last().commanded.stacked().norm(), 0);
  EXPECT_GT(driver.watch.felt(), 100u);
  EXPECT_GT(driver.counters().rejected_wrenches, 0u);
}

}  // namespace
}  // namespace spidar::test::haptic_loop_track_test
