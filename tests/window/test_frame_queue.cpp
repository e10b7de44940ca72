// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames wait until they are on the screen.
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "plugin/window/model/frame_queue.h"
#include "tests/support/element_harness.h"

namespace spidar::test::frame_queue_test {
namespace {

class Frames {
 public:
  Frames() {
    init_gstreamer();
    gst_video_info_set_format(&info_, GST_VIDEO_FORMAT_GRAY8, 4, 4);
  }

  void pass(int64_t running_ns) {
    GstBuffer* const buffer =
        gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info_), nullptr);
    gst_buffer_memset(buffer, 0, static_cast<guint8>(running_ns), GST_VIDEO_INFO_SIZE(&info_));
    GstVideoFrame frame;
    ASSERT_TRUE(gst_video_frame_map(&frame, &info_, buffer, GST_MAP_READ));
    FrameFacts facts;
    facts.running_ns = running_ns;
    EXPECT_TRUE(feed_.give(frame, facts));
    gst_video_frame_unmap(&frame);
    gst_buffer_unref(buffer);
    queue_.fill(feed_);
  }
  /// The running time of what is shown from now on; −1: of what was shown before.
  int64_t show(std::optional<int64_t> running_ns) {
    if (!queue_.show(running_ns, picture_, facts_)) return -1;
    uint8_t level = 0;
    gst_buffer_extract(picture_.buffer(), 0, &level, 1);
    EXPECT_EQ(level, static_cast<uint8_t>(facts_.running_ns)) << "the picture of these facts";
    return facts_.running_ns;
  }

 private:
  GstVideoInfo info_;
  FrameFeed feed_;
  FrameQueue queue_;
  PictureCopy picture_;
  FrameFacts facts_;
};

TEST(FrameQueue, ShowsTheNewestThatIsOnTheScreen) {
  Frames frames;
  EXPECT_EQ(frames.show(10), -1) << "there is none";
  for (const int64_t at_ns : {10, 20, 30, 40}) frames.pass(at_ns);
  EXPECT_EQ(frames.show(9), -1);
  EXPECT_EQ(frames.show(10), 10);
  EXPECT_EQ(frames.show(19), -1);
  EXPECT_EQ(frames.show(35), 30);
  frames.pass(50);
  EXPECT_EQ(frames.show(45), 40);
  EXPECT_EQ(frames.show(std::nullopt), 50) << "nothing is felt, as in a pause";
}

TEST(FrameQueue, ForgetsWhatWaitsWhenTimeBeginsAnew) {
  Frames frames;
  frames.pass(100);
  frames.pass(110);
  frames.pass(0);
  EXPECT_EQ(frames.show(200), 0);
  EXPECT_EQ(frames.show(200), -1);
}

TEST(FrameQueue, ShowsTheOldestWhenTooManyWait) {
  Frames frames;
  constexpr auto kMost = static_cast<int64_t>(FrameQueue::kMost);
  for (int64_t i = 1; i <= kMost; ++i) frames.pass(10 * i);
  EXPECT_EQ(frames.show(0), -1);
  frames.pass(10 * (kMost + 1));
  EXPECT_EQ(frames.show(0), 10);
  EXPECT_EQ(frames.show(0), -1);
}

}  // namespace
}  // namespace spidar::test::frame_queue_test
