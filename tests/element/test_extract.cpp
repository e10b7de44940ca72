// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarextract: frames with the meta of spidarmotion in, a track out.
#include "tests/element/extract_harness.h"
#include "tests/support/test.h"

namespace spidar::test::extract_test {
namespace {

TEST_F(Extract, AMinuteOfFilmGivesSixtyThousandSamplesThatMeetEveryMotion) {
  constexpr int kFrames = 1500;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_EQ(gst_harness_push(
                  h, make_frame(static_cast<GstClockTime>(i) * kExtractedFrame, wrench_of(i))),
              GST_FLOW_OK);
  }
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  ASSERT_EQ(samples.size(), 60000u);
  EXPECT_EQ(begin, 0u);
  for (int i = 1; i < kFrames; ++i) {
    // What a float is rounded by, of a full scale of 10 N.
    const Wrench felt = to_wrench(samples[static_cast<size_t>(40 * i - 20)]);
    ASSERT_LE((felt.stacked() - wrench_of(i).stacked()).norm(), 1e-6) << i;
  }
  EXPECT_EQ(warnings(), 0);
}

TEST_F(Extract, PassesTheVideoOnUntouched) {
  open("src");
  GstBuffer* frame = make_frame(0, wrench_of(1));
  ASSERT_EQ(gst_harness_push(h, frame), GST_FLOW_OK);
  GstBuffer* out = gst_harness_pull(h);
  EXPECT_EQ(out, frame);
  gst_buffer_unref(out);
  GstCaps* caps = gst_pad_get_current_caps(h->sinkpad);
  GstCaps* given = gst_caps_from_string(kExtractedVideo);
  EXPECT_TRUE(gst_caps_is_equal(caps, given));
  gst_caps_unref(given);
  gst_caps_unref(caps);
}

TEST_F(Extract, IsSilentWithOneWarningWhereFramesHaveNoMeta) {
  for (GstClockTime i = 0; i < 25; ++i) gst_harness_push(h, bare_frame(i * kExtractedFrame));
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(samples.size(), 1000u);
  for (const TrackSample& sample : samples) EXPECT_EQ(sample, TrackSample{});
  EXPECT_EQ(warnings(), 1);
}

TEST_F(Extract, BeginsWhereASeekLeads) {
  gst_harness_push(h, make_frame(0, wrench_of(1)));
  gst_harness_push(h, make_frame(kExtractedFrame, wrench_of(2)));
  gst_harness_push_event(h, gst_event_new_flush_start());
  gst_harness_push_event(h, gst_event_new_flush_stop(TRUE));
  begin_segment(1, 4320 * GST_MSECOND);
  for (GstClockTime i = 108; i < 120; ++i) {
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(static_cast<double>(i))));
  }
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(begin, 0u) << "running time begins anew";
  EXPECT_EQ(gst_segment_to_stream_time(&take_segments().back(), GST_FORMAT_TIME, begin),
            4320 * GST_MSECOND);
  EXPECT_EQ(samples.size(), 480u);
  expect_motion(109, 40);
}

TEST_F(Extract, ATrackBeginsWithItsSegmentAndNotWithTheFirstFrame) {
  gst_harness_push(h, make_frame(2 * kExtractedFrame, wrench_of(1)));
  gst_harness_push(h, make_frame(3 * kExtractedFrame, wrench_of(2)));
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(begin, 0u);
  ASSERT_EQ(samples.size(), 160u);
  EXPECT_EQ(samples[0], TrackSample{});
  EXPECT_EQ(samples[79], TrackSample{}) << "nothing is known before the first frame";
  expect_motion(2, 120);
}

TEST_F(Extract, EndsWithTheSegment) {
  begin_segment(1, 0, 100 * GST_MSECOND);
  for (GstClockTime i = 0; i < 10; ++i)
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(1)));
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  EXPECT_EQ(samples.size(), 100u);
}

TEST_F(Extract, AGapOfTheVideoIsRest) {
  for (GstClockTime i = 0; i < 5; ++i)
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(1)));
  gst_harness_push_event(h, gst_event_new_gap(5 * kExtractedFrame, 10 * kExtractedFrame));
  for (GstClockTime i = 15; i < 20; ++i)
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(1)));
  gst_harness_push_event(h, gst_event_new_eos());
  take_all();
  ASSERT_EQ(samples.size(), 800u);
  for (size_t ms = 200; ms < 560; ++ms) EXPECT_EQ(samples[ms], TrackSample{}) << ms;
  EXPECT_EQ(samples[600], to_track_sample(wrench_of(1)));
}

TEST_F(Extract, BackwardsThereAreGapsOnly) {
  begin_segment(-1, 0, 10 * kExtractedFrame);
  for (GstClockTime i = 10; i-- > 0;)
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(1)));
  take_all();
  EXPECT_TRUE(samples.empty());
  int gaps = 0;
  while (GstEvent* event = gst_harness_try_pull_event(h)) {
    if (GST_EVENT_TYPE(event) == GST_EVENT_GAP) ++gaps;
    gst_event_unref(event);
  }
  EXPECT_EQ(gaps, 10);
}

TEST_F(Extract, ReportsTheLatencyOfSamples) {
  gst_harness_set_upstream_latency(h, 7 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(h), 7 * GST_MSECOND + tracks::Stream::latency_ns());
  open("src");
  gst_harness_set_upstream_latency(h, 7 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(h), 7 * GST_MSECOND);
}

TEST_F(Extract, NoSampleExceedsTheLatency) {
  for (GstClockTime i = 0; i < 50; ++i) {
    gst_harness_push(h, make_frame(i * kExtractedFrame, wrench_of(1)));
    take_all();
    EXPECT_GE(samples.size() * kTrackPeriod_ns + tracks::Stream::latency_ns(), i * kExtractedFrame);
  }
}

TEST_F(Extract, TakesTheMaskThatDownstreamWants) {
  for (const char* mask : {"0x3f", "0x0"}) {
    open("wrench");
    gst_harness_set_sink_caps_str(
        h, (std::string("audio/x-raw,format=F32LE,layout=interleaved,rate=1000,channels=6,"
                        "channel-mask=(bitmask)") +
            mask)
               .c_str());
    gst_harness_push(h, make_frame(0, wrench_of(1)));
    gst_harness_push_event(h, gst_event_new_eos());
    GstBuffer* buffer = gst_harness_try_pull(h);
    EXPECT_NE(buffer, nullptr) << mask;
    if (buffer) gst_buffer_unref(buffer);
  }
}

}  // namespace
}  // namespace spidar::test::extract_test
