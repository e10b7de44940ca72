// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Counters of a board that wrap round, jump or restart.
#include <array>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "spidar/boards/encoder_counts.h"

namespace spidar::test::count_unwrapper_test {
namespace {

using Raw = std::array<uint32_t, kMaxStrings>;

TEST(CountUnwrapper, GoesOnWhereTheCounterWraps) {
  CountUnwrapper unwrapper(16);
  unwrapper.begin(Raw{0x7FF0, 0x8010, 5}, 3);
  EXPECT_EQ(unwrapper.counts()[0], 0x7FF0);
  EXPECT_EQ(unwrapper.counts()[1], -0x7FF0);
  ASSERT_TRUE(unwrapper.follow(Raw{0x8010, 0x7FF0, 4}, 3));
  EXPECT_EQ(unwrapper.counts()[0], 0x8010);
  EXPECT_EQ(unwrapper.counts()[1], -0x8010);
  EXPECT_EQ(unwrapper.counts()[2], 4);
  // Ten times round and back.
  uint32_t at = 4;
  for (int step = 0; step < 80; ++step)
    ASSERT_TRUE(unwrapper.follow(Raw{0x8010, 0x7FF0, at = (at + 8192) & 0xFFFF}, 3));
  EXPECT_EQ(unwrapper.counts()[2], 4 + 80 * 8192);
  for (int step = 0; step < 80; ++step)
    ASSERT_TRUE(unwrapper.follow(Raw{0x8010, 0x7FF0, at = (at - 8192) & 0xFFFF}, 3));
  EXPECT_EQ(unwrapper.counts()[2], 4);
}

// Switching a board off and on takes its counters to zero wherever the grip is. Within 17 mm of the
// counters' old zero that is no jump, and shows only in that they are near zero and have changed.
TEST(CountUnwrapper, NoticesAPowerCycleNearZero) {
  for (const uint32_t before : {100u, 900u, 5000u, 0xFC00u}) {
    CountUnwrapper unwrapper(16);
    unwrapper.begin(Raw{before, 20, 0xFFF0}, 3);
    EXPECT_FALSE(unwrapper.resume(Raw{0, 0, 0}, 3)) << "before " << before;
    EXPECT_FALSE(unwrapper.resume(Raw{3, 0xFFFE, 12}, 3)) << "before " << before;
    EXPECT_EQ(unwrapper.counts()[1], 20);
  }
}

TEST(CountUnwrapper, GoesOnAfterABreakWithoutAPowerCycle) {
  CountUnwrapper unwrapper(16);
  unwrapper.begin(Raw{900, 20, 0xFFF0}, 3);
  EXPECT_TRUE(unwrapper.resume(Raw{880, 60, 0xFFE0}, 3)) << "hardly moved";
  EXPECT_TRUE(unwrapper.resume(Raw{3000, 60, 0xFFE0}, 3)) << "moved, and not to zero";
  // Less than a millimetre from the counters' zero a power cycle does no harm.
  CountUnwrapper at_zero(16);
  at_zero.begin(Raw{30, 0xFFE0, 10}, 3);
  EXPECT_TRUE(at_zero.resume(Raw{500, 0, 0xFE00}, 3));
}

TEST(CountUnwrapper, RefusesJumpsAndKeepsWhatItHad) {
  for (const int bits : {16, 24}) {
    CountUnwrapper unwrapper(bits);
    unwrapper.begin(Raw{100, 200}, 2);
    EXPECT_TRUE(unwrapper.follow(Raw{100 + 16384, 200}, 2));
    EXPECT_FALSE(unwrapper.follow(Raw{100, 200 + 16385}, 2)) << bits;
    EXPECT_EQ(unwrapper.counts()[0], 100 + 16384);
    EXPECT_EQ(unwrapper.counts()[1], 200);
  }
  CountUnwrapper unwrapper(24);
  unwrapper.begin(Raw{0xFFFFFF}, 1);
  EXPECT_EQ(unwrapper.counts()[0], -1);
  ASSERT_TRUE(unwrapper.follow(Raw{3}, 1));
  EXPECT_EQ(unwrapper.counts()[0], 3);
}

}  // namespace
}  // namespace spidar::test::count_unwrapper_test
