// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reliefs passed between two threads (also for the thread sanitizer).
#include "spidar/touch/touch_rendering.h"
#include "tests/support/test.h"

namespace spidar::test::touch_mailbox_test {
namespace {

constexpr double kWidth_m = 0.06;
constexpr double kHeight_m = 0.04;

void fill(touch::HeightField& field, float z_m) {
  for (int y = 0; y < touch::HeightField::kRows; ++y) {
    for (int x = 0; x < touch::HeightField::kColumns; ++x) field.row(y)[x] = z_m;
  }
}

bool is_all(const touch::HeightField& field, float z_m) {
  for (int y = 0; y < touch::HeightField::kRows; ++y) {
    for (int x = 0; x < touch::HeightField::kColumns; ++x) {
      if (field.row(y)[x] != z_m) return false;
    }
  }
  return true;
}

bool publish(touch::Mailbox& mailbox, int64_t number) {
  touch::Surface* const frame = mailbox.begin(mailbox.generation());
  if (frame == nullptr) return false;
  frame->time_ns = number;
  fill(frame->relief, static_cast<float>(number));
  fill(frame->texture, static_cast<float>(number));
  mailbox.publish();
  return true;
}

TEST(TouchMailbox, AFrameIsOfTheGenerationItWasBegunIn) {
  touch::Mailbox mailbox(kWidth_m, kHeight_m, 3);
  const uint32_t before = mailbox.generation();
  mailbox.clear();
  ASSERT_NE(mailbox.begin(before), nullptr);
  mailbox.publish();
  EXPECT_EQ(mailbox.front()->generation, before);
  EXPECT_NE(mailbox.front()->generation, mailbox.generation());
}

TEST(TouchMailbox, RefusesWhatCannotWork) {
  EXPECT_THROW(touch::Mailbox(kWidth_m, kHeight_m, 2), std::invalid_argument);
  EXPECT_THROW(touch::Mailbox(0, kHeight_m, 3), std::invalid_argument);
  EXPECT_THROW(touch::Mailbox(kWidth_m, -1, 3), std::invalid_argument);
  EXPECT_THROW(touch::Mailbox(kWidth_m, std::numeric_limits<double>::quiet_NaN(), 3),
               std::invalid_argument);
}

/// The reader looks at the two oldest frames for as long as it likes, and at every cell of them,
/// while the writer fills the third slot.
TEST(TouchMailbox, NothingIsTornOrLostBetweenThreads) {
  constexpr int64_t kFrames = 1000;
  touch::Mailbox mailbox(kWidth_m, kHeight_m, touch::Mailbox::kMinSlots);
  std::thread writer([&] {
    for (int64_t n = 1; n <= kFrames; ++n) {
      while (!publish(mailbox, n)) std::this_thread::yield();
    }
  });
  int64_t torn = 0;
  int64_t out_of_order = 0;
  for (int64_t n = 1; n <= kFrames; ++n) {
    const touch::Surface* oldest = nullptr;
    while ((oldest = mailbox.front()) == nullptr) std::this_thread::yield();
    const touch::Surface* const next = mailbox.front(1);
    for (const touch::Surface* frame : {oldest, next}) {
      if (frame == nullptr) continue;
      const auto z_m = static_cast<float>(frame->time_ns);
      if (!is_all(frame->relief, z_m) || !is_all(frame->texture, z_m)) ++torn;
    }
    if (oldest->time_ns != n || (next != nullptr && next->time_ns != n + 1)) ++out_of_order;
    mailbox.drop();
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(out_of_order, 0);
  EXPECT_EQ(mailbox.front(), nullptr);
}

/// A third thread forgets what there is, as a flush does. What is begun after that is seen.
TEST(TouchMailbox, ForgettingReachesTheReaderFromAnyThread) {
  constexpr uint32_t kTimes = 1000;
  touch::Mailbox mailbox(kWidth_m, kHeight_m, touch::Mailbox::kMinSlots);
  std::atomic<bool> done{false};
  std::thread flusher([&] {
    for (uint32_t n = 0; n < kTimes; ++n) {
      mailbox.clear();
      std::this_thread::yield();
    }
    done = true;
  });
  std::thread writer([&] {
    for (int64_t n = 1; !done; ++n) {
      if (touch::Surface* const frame = mailbox.begin(mailbox.generation())) {
        frame->time_ns = n;
        mailbox.publish();
      } else {
        std::this_thread::yield();
      }
    }
  });
  uint32_t last = 0;
  bool rising = true;
  while (!done) {
    if (const touch::Surface* const frame = mailbox.front()) {
      rising = rising && frame->generation >= last && frame->generation <= kTimes;
      last = frame->generation;
      mailbox.drop();
    }
  }
  flusher.join();
  writer.join();
  EXPECT_TRUE(rising);
  while (mailbox.front() != nullptr) mailbox.drop();
  ASSERT_NE(mailbox.begin(mailbox.generation()), nullptr);
  mailbox.publish();
  EXPECT_EQ(mailbox.front()->generation, kTimes);
}

}  // namespace
}  // namespace spidar::test::touch_mailbox_test
