// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which depth image belongs to which frame.
#include <vector>

#include <gtest/gtest.h>

#include "plugin/depth/depth_match.h"

namespace spidar::test::depth_match_test {
namespace {

constexpr gint64 kMs = GST_MSECOND;

DepthImage image_at(gint64 start_ns, gint64 length_ns) {
  DepthImage image;
  image.buffer.reset(gst_buffer_new());
  image.caps.reset(gst_caps_new_empty_simple("video/x-raw"));
  image.time = {start_ns, start_ns + length_ns};
  return image;
}

struct Film {
  gint64 first_ns, frame_ns;
  int frames;
};

/// The begin of the image that each frame gets, −1 for none; `images` arrive when they are
/// requested.
std::vector<gint64> match(const Film& video, const std::vector<ShownTime>& images,
                          guint64 max_age_ns = 0) {
  gst_init(nullptr, nullptr);
  DepthMatch match;
  size_t next = 0;
  std::vector<gint64> found;
  for (int n = 0; n < video.frames; ++n) {
    const gint64 start = video.first_ns + n * video.frame_ns;
    const ShownTime frame{start, start + video.frame_ns};
    while (!match.settled(frame)) {
      EXPECT_TRUE(match.has_room()) << "waits for what cannot come";
      if (next < images.size()) {
        match.add(image_at(images[next].start_ns, images[next].length_ns()));
        ++next;
      } else {
        match.finish();
      }
    }
    const DepthImage* image = match.find(frame, max_age_ns);
    found.push_back(image ? image->time.start_ns : -1);
  }
  return found;
}

std::vector<ShownTime> images(gint64 first_ns, gint64 length_ns, int count) {
  std::vector<ShownTime> times;
  for (int n = 0; n < count; ++n) {
    times.push_back({first_ns + n * length_ns, first_ns + (n + 1) * length_ns});
  }
  return times;
}

TEST(DepthMatch, OfTheSameRateIsTheSameFrame) {
  const std::vector<gint64> found = match({0, 40 * kMs, 50}, images(0, 40 * kMs, 50));
  for (size_t n = 0; n < 50; ++n) EXPECT_EQ(found[n], static_cast<gint64>(n) * 40 * kMs);
}

TEST(DepthMatch, OfTheSameRateIsTheNearestFrame) {
  // Up to half a frame late it is the one that begins later, beyond the one before.
  for (const gint64 late : {3 * kMs, 19 * kMs, 21 * kMs, 38 * kMs}) {
    const std::vector<gint64> found =
        match({1000 * kMs, 40 * kMs, 25}, images(1000 * kMs - 40 * kMs + late, 40 * kMs, 60));
    for (size_t n = 0; n < 25; ++n) {
      const gint64 apart = found[n] - (1000 + 40 * static_cast<gint64>(n)) * kMs;
      EXPECT_EQ(apart, late < 20 * kMs ? late : late - 40 * kMs) << late;
    }
  }
}

TEST(DepthMatch, SlowerDepthIsHeld) {
  const std::vector<gint64> found = match({0, 40 * kMs, 50}, images(0, 200 * kMs, 10));
  for (size_t n = 0; n < 50; ++n) EXPECT_EQ(found[n], static_cast<gint64>(n / 5) * 200 * kMs) << n;
}

TEST(DepthMatch, OfFasterDepthMostIsLeftOut) {
  const std::vector<gint64> found = match({0, 40 * kMs, 50}, images(0, 10 * kMs, 200));
  for (size_t n = 0; n < 50; ++n) EXPECT_EQ(found[n], static_cast<gint64>(n) * 40 * kMs) << n;
}

TEST(DepthMatch, IsUsedUntilItIsTooOld) {
  std::vector<ShownTime> times = images(0, 40 * kMs, 3);
  times.push_back({2000 * kMs, 2040 * kMs});
  const std::vector<gint64> found = match({0, 40 * kMs, 51}, times, 100 * kMs);
  // The third ends at 120 ms and is kept until 220 ms.
  EXPECT_EQ(found[5], 80 * kMs);
  EXPECT_EQ(found[6], -1);
  EXPECT_EQ(found[49], -1);
  EXPECT_EQ(found[50], 2000 * kMs);
}

TEST(DepthMatch, OfWhatHasNoLengthIsTheLastOneBefore) {
  const std::vector<gint64> found =
      match({0, 40 * kMs, 4}, {{0, 0}, {50 * kMs, 50 * kMs}, {119 * kMs, 119 * kMs}}, 1000 * kMs);
  EXPECT_EQ(found, (std::vector<gint64>{0, 50 * kMs, 50 * kMs, 119 * kMs}));
}

TEST(DepthMatch, DoesNotWaitWhereDepthSaysThatNothingComes) {
  DepthMatch match;
  const ShownTime frame{0, 40 * kMs};
  EXPECT_FALSE(match.settled(frame));
  match.reach(20 * kMs);
  EXPECT_FALSE(match.settled(frame)) << "one at 20 ms would still be the frame's";
  match.reach(21 * kMs);
  EXPECT_TRUE(match.settled(frame));
  EXPECT_EQ(match.find(frame, 0), nullptr);
}

TEST(DepthMatch, DepthOfAnotherTimeIsNotUsed) {
  DepthMatch match;
  match.add(image_at(9000 * kMs, 40 * kMs));
  ASSERT_TRUE(match.settled({9000 * kMs, 9040 * kMs}));
  match.add(image_at(9040 * kMs, 40 * kMs));
  // The video has gone back without the depth.
  ASSERT_TRUE(match.settled({0, 40 * kMs}));
  EXPECT_EQ(match.find({0, 40 * kMs}, G_MAXUINT64), nullptr);
}

TEST(DepthMatch, BackwardsTheEndIsShownFirst) {
  gst_init(nullptr, nullptr);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.rate = -2;
  segment.start = 0;
  segment.stop = 1000 * kMs;
  GstBuffer* buffer = gst_buffer_new();
  GST_BUFFER_PTS(buffer) = 960 * kMs;
  const auto time = shown_time(segment, buffer, 40 * kMs);
  ASSERT_TRUE(time);
  EXPECT_EQ(time->start_ns, 0);
  EXPECT_EQ(time->end_ns, 20 * kMs) << "twice as fast";
  GST_BUFFER_PTS(buffer) = GST_CLOCK_TIME_NONE;
  EXPECT_FALSE(shown_time(segment, buffer, 40 * kMs));
  GST_BUFFER_PTS(buffer) = 0;
  gst_segment_init(&segment, GST_FORMAT_BYTES);
  EXPECT_FALSE(shown_time(segment, buffer, 0));
  gst_buffer_unref(buffer);
}

}  // namespace
}  // namespace spidar::test::depth_match_test
