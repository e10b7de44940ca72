// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Seqlock and ring, alone and between two threads (for the thread sanitizer).
#include "spidar/realtime/seqlock.h"
#include "spidar/realtime/spsc_ring.h"
#include "tests/support/test.h"

namespace spidar::test::shared_memory_test {
namespace {

/// Torn when its words differ. Large, so that a thread is likely to be held up within it.
struct Block {
  std::array<uint64_t, 1024> words{};
  static Block of(uint64_t value) {
    Block block;
    block.words.fill(value);
    return block;
  }
  bool whole() const {
    for (const uint64_t word : words) {
      if (word != words[0]) return false;
    }
    return true;
  }
};

TEST(Seqlock, OddSizes) {
  struct Small {
    char text[11] = "0123456789";
  };
  Seqlock<Small> lock;
  EXPECT_STREQ(lock.load().text, "0123456789");
}

TEST(Seqlock, NeverTornAndNeverBackwards) {
  Seqlock<Block> lock;
  constexpr uint64_t kStores = 20'000;
  std::thread writer([&] {
    for (uint64_t i = 1; i <= kStores; ++i) lock.store(Block::of(i));
  });
  uint64_t last = 0;
  bool whole = true;
  bool rising = true;
  Block maybe;
  while (last < kStores) {
    const Block block = lock.load();
    whole = whole && block.whole();
    rising = rising && block.words[0] >= last;
    last = block.words[0];
    if (lock.try_load(maybe)) rising = rising && maybe.words[0] >= last;
    whole = whole && maybe.whole();
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(rising);
}

TEST(SpscRing, LosesNothingBetweenThreads) {
  SpscRing<Block, 16> ring;
  constexpr uint64_t kEntries = 50'000;
  std::thread writer([&] {
    for (uint64_t i = 1; i <= kEntries; ++i) {
      while (!ring.push(Block::of(i))) std::this_thread::yield();
    }
  });
  uint64_t in_order = 0;
  Block block;
  for (uint64_t i = 1; i <= kEntries; ++i) {
    while (!ring.pop(block)) std::this_thread::yield();
    if (block.whole() && block.words[0] == i) ++in_order;
  }
  writer.join();
  EXPECT_EQ(in_order, kEntries);
}

}  // namespace
}  // namespace spidar::test::shared_memory_test
