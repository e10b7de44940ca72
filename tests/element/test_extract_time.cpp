// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Where the samples of spidarextract lie in time, whatever segments and time stamps the film has.
#include "tests/element/extract_harness.h"
#include "tests/support/test.h"

namespace spidar::test::extract_time_test {
namespace {

using ExtractTime = Extract;

// matroskademux when the sound begins 21 ms before the pictures: one segment for the first frame,
// and another one, that begins earlier, when the first packet of sound comes.
TEST_F(ExtractTime, ASegmentThatMovesAfterTheFirstFrameDoesNotBeginTheTrackAgain) {
  constexpr GstClockTime kFirst = 21 * GST_MSECOND;
  push_segment({1, kFirst, GST_CLOCK_TIME_NONE, 0, 0});
  push_frames(0, 0, kFirst);
  push_segment({1, 0, GST_CLOCK_TIME_NONE, 0, 0});
  push_frames(1, 24, kFirst + kExtractedFrame);
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(begin, 0u);
  ASSERT_EQ(samples.size(), 1021u);
  for (size_t i = 1; i < 25; ++i) expect_motion(i, 21 + 40 * i);
  // One is what the harness begins with.
  EXPECT_EQ(take_segments().size(), 1u);
}

// qtdemux for an edit list: nothing for 200 ms, then the media from 80 ms on, then a part again.
TEST_F(ExtractTime, EditsLieWhereThePlayerShowsThem) {
  push_segment({1, 0, 5 * kExtractedFrame, 0, 0});
  push_segment(
      {1, 2 * kExtractedFrame, 12 * kExtractedFrame, 5 * kExtractedFrame, 5 * kExtractedFrame});
  push_frames(5, 14, 2 * kExtractedFrame);
  push_segment(
      {1, 4 * kExtractedFrame, 9 * kExtractedFrame, 15 * kExtractedFrame, 15 * kExtractedFrame});
  push_frames(15, 19, 4 * kExtractedFrame);
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(begin, 0u);
  ASSERT_EQ(samples.size(), 800u);
  for (size_t ms = 0; ms < 5 * 40; ms += 40) EXPECT_EQ(samples[ms], TrackSample{}) << ms;
  for (size_t i = 6; i < 20; ++i) expect_motion(i, 40 * i);
  EXPECT_EQ(take_segments().size(), 1u);
}

TEST_F(ExtractTime, WhereStreamTimeBeginsAnewSamplesGoOn) {
  push_frames(0, 9, 0);
  push_segment({1, kExtractedFrame, GST_CLOCK_TIME_NONE, 0, 12 * kExtractedFrame});
  push_frames(12, 19, kExtractedFrame);
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  ASSERT_EQ(samples.size(), 800u);
  for (size_t i : {1u, 9u, 13u, 19u}) expect_motion(i, 40 * i);
  for (size_t ms = 400; ms < 440; ++ms) EXPECT_EQ(samples[ms], TrackSample{}) << ms;
  const std::vector<GstSegment> segments = take_segments();
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(gst_segment_to_stream_time(&segments[1], GST_FORMAT_TIME, 13 * kExtractedFrame),
            kExtractedFrame);
  EXPECT_EQ(gst_segment_to_running_time(&segments[1], GST_FORMAT_TIME, 13 * kExtractedFrame),
            13 * kExtractedFrame);
}

TEST_F(ExtractTime, AtTwiceTheRateThereAreHalfAsManySamples) {
  begin_segment(2, 0);
  push_frames(0, 24, 0, kExtractedFrame / 2);
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  ASSERT_EQ(samples.size(), 500u);
  for (size_t i = 1; i < 25; ++i) expect_motion(i, 20 * i, 20);
  EXPECT_EQ(
      gst_segment_to_stream_time(&take_segments().back(), GST_FORMAT_TIME, 5 * kExtractedFrame),
      10 * kExtractedFrame);
}

TEST_F(ExtractTime, OneWildTimeStampIsLeftOutWithAWarning) {
  constexpr GstClockTime kWild = 1'000'000 * GST_SECOND;
  for (const GstClockTime from : {0 * kExtractedFrame, 5 * kExtractedFrame}) {
    open("wrench");
    samples.clear();
    push_frames(0, static_cast<int>(from / kExtractedFrame) - 1, 0);
    push_frames(0, 0, kWild);
    EXPECT_EQ(warnings(), 1);
    push_frames(static_cast<int>(from / kExtractedFrame), 9, from);
    gst_harness_push_event(h, gst_event_new_eos());
    take_all();
    EXPECT_EQ(begin, 0u);
    ASSERT_EQ(samples.size(), 400u);
    for (size_t i = 1; i < 10; ++i) expect_motion(i, 40 * i);
    EXPECT_EQ(warnings(), 0);
  }
}

TEST_F(ExtractTime, AfterAJumpOfDaysTheTrackGoesOnWithoutDaysOfSilence) {
  constexpr GstClockTime kLater = 1'000'000 * GST_SECOND;
  push_frames(0, 4, 0);
  push_frames(0, 9, kLater);
  GstBuffer* frame = make_frame(kLater + 10 * kExtractedFrame, Wrench());
  GST_BUFFER_DURATION(frame) = kLater;
  ASSERT_EQ(gst_harness_push(h, frame), GST_FLOW_OK);
  gst_harness_push_event(h, gst_event_new_gap(3 * kLater, kExtractedFrame));
  gst_harness_push_event(h, gst_event_new_eos());
  size_t count = 0;
  GstClockTime last = 0;
  while (GstBuffer* buffer = gst_harness_try_pull(h)) {
    if (GST_BUFFER_PTS(buffer) > last + kExtractedFrame) {
      EXPECT_EQ(count, 200u);
      EXPECT_EQ(GST_BUFFER_PTS(buffer), kLater + kExtractedFrame)
          << "the first frame might have been alone";
      EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT));
    }
    last = GST_BUFFER_PTS(buffer);
    count += gst_buffer_get_size(buffer) / sizeof(TrackSample);
    gst_buffer_unref(buffer);
  }
  // The last frame is held as long as the interval before it, instead of its own duration.
  EXPECT_EQ(count, 200u + 10 * 40);
  EXPECT_EQ(warnings(), 1);
}

}  // namespace
}  // namespace spidar::test::extract_time_test
