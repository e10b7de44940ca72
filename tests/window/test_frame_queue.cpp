// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames wait until they are on the screen, and give their pictures back.
#include "plugin/window/program/player_link.h"
#include "tests/support/test.h"

namespace spidar::test::frame_queue_test {
namespace {

class Frames {
 public:
  void pass(int64_t running_ns, uint32_t epoch = 0) {
    window::QueuedFrame frame{};
    frame.picture =
        window::SharedPicture(nullptr, 0, [this, running_ns] { freed.push_back(running_ns); });
    frame.report.stamp.running_ns = running_ns;
    frame.report.stamp.epoch = epoch;
    queue_.add(std::move(frame));
  }
  /// The running time of what is shown from now on; −1: of what was shown before.
  int64_t show(std::optional<int64_t> running_ns) {
    std::optional<window::QueuedFrame> frame = queue_.show(running_ns);
    if (!frame) return -1;
    shown_ = std::move(*frame);
    return shown_.report.stamp.running_ns;
  }

  std::vector<int64_t> freed;  ///< the pictures that nobody keeps any more

 private:
  window::FrameQueue queue_;
  window::QueuedFrame shown_;
};

TEST(FrameQueue, ShowsTheNewestThatIsOnTheScreenAndKeepsNoOther) {
  Frames frames;
  EXPECT_EQ(frames.show(10), -1) << "there is none";
  for (const int64_t at_ns : {10, 20, 30, 40}) frames.pass(at_ns);
  EXPECT_EQ(frames.show(9), -1);
  EXPECT_EQ(frames.show(10), 10);
  EXPECT_EQ(frames.show(19), -1);
  EXPECT_TRUE(frames.freed.empty());
  EXPECT_EQ(frames.show(35), 30);
  EXPECT_EQ(frames.freed, (std::vector<int64_t>{20, 10}));
  frames.pass(50);
  EXPECT_EQ(frames.show(45), 40);
  EXPECT_EQ(frames.show(std::nullopt), 50) << "nothing is felt, as in a pause";
}

TEST(FrameQueue, ForgetsWhatWaitsWhenTimeBeginsAnew) {
  Frames frames;
  frames.pass(100);
  frames.pass(110);
  frames.pass(0, 1);
  EXPECT_EQ(frames.freed.size(), 2u);
  EXPECT_EQ(frames.show(200), 0);
  EXPECT_EQ(frames.show(200), -1);
}

TEST(FrameQueue, KeepsTheEndOfAFilmThatAnotherFollowsWithoutAGap) {
  Frames frames;
  frames.pass(100);
  frames.pass(110, 1);
  EXPECT_EQ(frames.show(105), 100);
  EXPECT_EQ(frames.show(115), 110);
}

TEST(FrameQueue, ShowsTheOldestWhenTooManyWait) {
  Frames frames;
  constexpr auto kMax = static_cast<int64_t>(window::FrameQueue::kMax);
  for (int64_t i = 1; i <= kMax; ++i) frames.pass(10 * i);
  EXPECT_EQ(frames.show(0), -1);
  frames.pass(10 * (kMax + 1));
  EXPECT_EQ(frames.show(0), 10);
  EXPECT_EQ(frames.show(0), -1);
}

}  // namespace
}  // namespace spidar::test::frame_queue_test
