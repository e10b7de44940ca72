// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Timestamps, segments and discontinuities: motion is measured over running time, and only between
// two frames that are shown in succession.
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::time_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr double kTolerance_px = 0.1;  // see test_frames.cpp

void send_segment(ElementHarness& h, double rate, GstClockTime start,
                  GstClockTime stop = GST_CLOCK_TIME_NONE, GstClockTime base = 0) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.rate = rate;
  segment.base = base;
  segment.start = segment.time = start;
  segment.stop = stop;
  segment.position = rate < 0 ? stop : start;
  gst_harness_push_event(h.harness(), gst_event_new_segment(&segment));
}

void flush(ElementHarness& h) {
  gst_harness_push_event(h.harness(), gst_event_new_flush_start());
  gst_harness_push_event(h.harness(), gst_event_new_flush_stop(TRUE));
}

struct Time : testing::Test {
  Time() { h.set_caps(make_caps("GRAY8", 320, 240)); }

  ElementHarness h;
};

TEST_F(Time, VelocityIsOverTheTimeThatPassesAndNotOverTheNominalRate) {
  h.push_moved(0, 0, 0);
  h.push_moved(2, 0, kFrame);
  h.push_moved(8, 0, 4 * kFrame);  // two frames were dropped on the way
  ASSERT_EQ(h.motions().size(), 3u);
  EXPECT_NEAR(h.motions()[1].velocity_x, 50, kTolerance_px / 0.04);
  EXPECT_NEAR(h.motions()[2].velocity_x, 50, kTolerance_px / 0.12);
}

TEST_F(Time, ReverseTurnsTheVelocityRound) {
  send_segment(h, -1.0, 0, GST_SECOND);
  h.push_moved(20, 0, 10 * kFrame);
  h.push_moved(18, 0, 9 * kFrame);
  ASSERT_EQ(h.motions().size(), 2u);
  EXPECT_NEAR(h.motions()[1].velocity_x, -50, kTolerance_px / 0.04);
  // Its end comes by first, 25 frames/s, and that is when sinks show it.
  EXPECT_EQ(h.motions()[1].running_time, GST_SECOND - 10 * kFrame);
}

TEST_F(Time, AFrameThatBeginsBeforeTheSegmentIsShownWithIt) {
  send_segment(h, 1.0, 10 * kFrame + kFrame / 2);
  h.push_moved(0, 0, 9 * kFrame);  // is over by then
  h.push_moved(2, 0, 10 * kFrame);
  h.push_moved(4, 0, 11 * kFrame);
  ASSERT_EQ(h.motions().size(), 2u);
  EXPECT_EQ(h.motions()[0].running_time, 0u);
  EXPECT_EQ(h.motions()[0].stream_time, 10 * kFrame + kFrame / 2);
  EXPECT_EQ(h.motions()[1].running_time, kFrame / 2);
}

TEST_F(Time, MessagesCarryAllTimes) {
  send_segment(h, 1.0, GST_SECOND);
  GstBuffer* frame = make_frame(h.info(), 0, 0);
  GST_BUFFER_DURATION(frame) = kFrame;
  h.push(frame, GST_SECOND + kFrame);
  ASSERT_EQ(h.motions().size(), 1u);
  const MotionMessage& m = h.motions()[0];
  EXPECT_EQ(m.timestamp, GST_SECOND + kFrame);
  EXPECT_EQ(m.running_time, kFrame);
  EXPECT_EQ(m.stream_time, GST_SECOND + kFrame);
  EXPECT_EQ(m.duration, kFrame);
}

TEST_F(Time, ASeekOfAnyLengthBeginsAnotherEpoch) {
  h.push_moved(0, 0, 0);
  GstClockTime at = GST_SECOND;
  constexpr GstClockTimeDiff kBy_ns[] = {40'000'000,   -40'000'000,      500'000'000,
                                         -500'000'000, 3600'000'000'000, -3600'000'000'000};
  for (const GstClockTimeDiff by : kBy_ns) {
    const uint32_t before = h.state().report().stamp.epoch;
    at += static_cast<GstClockTime>(by);
    flush(h);
    send_segment(h, 1.0, at);
    h.push_moved(0, 0, at);
    const FrameStamp first = h.state().report().stamp;
    EXPECT_NE(first.epoch, before) << by;
    EXPECT_EQ(first.stream_ns, static_cast<int64_t>(at));
    h.push_moved(0, 0, at + kFrame);
    EXPECT_EQ(h.state().report().stamp.epoch, first.epoch) << by;
  }
}

TEST_F(Time, AnotherFilmWithoutAGapBeginsAnotherEpoch) {
  h.push_moved(0, 0, 0);
  const uint32_t before = h.state().report().stamp.epoch;
  gst_harness_push_event(h.harness(), gst_event_new_stream_start("second"));
  send_segment(h, 1.0, 0, GST_CLOCK_TIME_NONE, kFrame);
  h.push_moved(2, 0, 0);
  EXPECT_NE(h.state().report().stamp.epoch, before);
  EXPECT_EQ(h.state().report().stamp.running_ns, static_cast<int64_t>(kFrame));
}

TEST_F(Time, AGapInTheFilmIsNoSeek) {
  h.push_moved(0, 0, 0);
  const uint32_t before = h.state().report().stamp.epoch;
  gst_harness_push_event(h.harness(), gst_event_new_gap(kFrame, 3 * GST_SECOND));
  h.push_moved(2, 0, 3 * GST_SECOND + kFrame);
  EXPECT_EQ(h.state().report().stamp.epoch, before);
}

TEST_F(Time, TheSameSegmentAgainIsNoCut) {
  send_segment(h, 1.0, 0);
  h.push_moved(0, 0, 0);
  send_segment(h, 1.0, 0);
  h.push_moved(2, 0, kFrame);
  ASSERT_EQ(h.motions().size(), 2u);
  EXPECT_NEAR(h.motions()[1].velocity_x, 50, kTolerance_px / 0.04);
}

TEST_F(Time, AfterAnInterruptionTheFirstFrameIsNoMotion) {
  struct Case {
    const char* name;
    std::function<void(ElementHarness&)> interrupt;
    GstClockTime next;  ///< the time of the frame after it
    guint flags;
    size_t warnings;
  };
  const auto nothing = [](ElementHarness&) {};
  const auto seek = [](ElementHarness& to) {
    flush(to);
    send_segment(to, 1.0, 0);
  };
  // As a gapless loop sends it: base goes on, the picture begins anew.
  const auto loop = [](ElementHarness& to) {
    send_segment(to, 1.0, 0, GST_CLOCK_TIME_NONE, 7 * kFrame);
  };
  for (const Case& c : {Case{"discontinuity", nothing, 7 * kFrame, GST_BUFFER_FLAG_DISCONT, 0},
                        {"seek", seek, 0, 0, 0},
                        {"loop", loop, 0, 0, 0},
                        {"falling timestamps", nothing, 3 * kFrame, 0, 1}}) {
    SCOPED_TRACE(c.name);
    ElementHarness frames;
    frames.set_caps(make_caps("GRAY8", 320, 240));
    frames.push_moved(0, 0, 5 * kFrame);
    frames.push_moved(2, 0, 6 * kFrame);
    c.interrupt(frames);
    frames.push_moved(9, 0, c.next, c.flags);
    frames.push_moved(11, 0, c.next + kFrame);
    ASSERT_EQ(frames.motions().size(), 4u);
    EXPECT_EQ(frames.motions()[2].velocity_x, 0);
    EXPECT_EQ(frames.motions()[2].wrench.force_N.norm(), 0);
    if (c.name == std::string("loop")) {
      EXPECT_EQ(frames.motions()[2].running_time, 7 * kFrame);
    }
    EXPECT_NEAR(frames.motions()[3].velocity_x, 50, kTolerance_px / 0.04);
    EXPECT_EQ(frames.warnings().size(), c.warnings);
  }
}

TEST_F(Time, AGapDoesNotStopTheFramesThatItHasOvertaken) {
  h.push_moved(0, 0, 0);
  h.push_moved(2, 0, kFrame);
  // As matroskademux sends it for pictures that have ended, while the decoder holds two of them.
  // With B-frames, it begins at the end of the packet that was decoded last.
  gst_harness_push_event(h.harness(), gst_event_new_gap(2 * kFrame, kFrame));
  gst_harness_push_event(h.harness(), gst_event_new_gap(4 * kFrame, kFrame));
  h.push_moved(4, 0, 2 * kFrame);
  gst_harness_push_event(h.harness(), gst_event_new_gap(4 * kFrame, kFrame));
  gst_harness_push_event(h.harness(), gst_event_new_gap(5 * kFrame, kFrame));
  h.push_moved(6, 0, 3 * kFrame);
  h.push_moved(9, 0, 6 * kFrame);
  h.push_moved(11, 0, 7 * kFrame);
  ASSERT_EQ(h.motions().size(), 6u);
  for (const size_t n : {1, 2, 3, 5}) {
    EXPECT_NEAR(h.motions()[n].velocity_x, 50, kTolerance_px / 0.04) << n;
  }
  EXPECT_EQ(h.motions()[4].velocity_x, 0);
}

TEST_F(Time, AGapLastsFromTheFirstOfItsEvents) {
  h.push_moved(0, 0, 0);
  h.push_moved(2, 0, kFrame);
  gst_harness_push_event(h.harness(), gst_event_new_gap(2 * kFrame, kFrame));
  gst_harness_push_event(h.harness(), gst_event_new_gap(5 * kFrame, kFrame));
  h.push_moved(8, 0, 4 * kFrame);
  ASSERT_EQ(h.motions().size(), 3u);
  EXPECT_EQ(h.motions()[2].velocity_x, 0);
}

TEST_F(Time, FramesWithoutTimestampAreShownAndWarnedAboutOnce) {
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(h.push_moved(2 * n, 0, GST_CLOCK_TIME_NONE), GST_FLOW_OK);
  }
  EXPECT_EQ(gst_harness_buffers_received(h.harness()), 3u);
  EXPECT_TRUE(h.motions().empty());
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("timestamp"), std::string::npos);
}

void append_to(GstDebugCategory*, GstDebugLevel, const gchar*, const gchar*, gint, GObject*,
               GstDebugMessage* message, gpointer lines) {
  *static_cast<std::string*>(lines) += std::string(gst_debug_message_get(message)) + "\n";
}

TEST_F(Time, TheLogSaysWhyAFrameIsNotAnalysed) {
  std::string log;
  gst_debug_set_threshold_for_name("spidarmotion", GST_LEVEL_DEBUG);
  gst_debug_add_log_function(append_to, &log, nullptr);
  h.push_moved(0, 0, GST_CLOCK_TIME_NONE);
  for (int n = 0; n < 3; ++n) h.push_moved(n, 0, 0);
  gst_debug_remove_log_function(append_to);
  gst_debug_unset_threshold_for_name("spidarmotion");
  EXPECT_NE(log.find("is not analysed: it has no timestamp\n"), std::string::npos) << log;
  EXPECT_NE(log.find("is not analysed: its timestamp is equal or nearly"), std::string::npos)
      << log;
}

TEST_F(Time, ASegmentInBytesHasNoTimeToBeFeltIn) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_BYTES);
  gst_harness_push_event(h.harness(), gst_event_new_segment(&segment));
  // Criticals of GStreamer's end the test.
  for (GstClockTime n = 0; n < 3; ++n) {
    EXPECT_EQ(h.push_moved(2.0 * static_cast<double>(n), 0, n * kFrame), GST_FLOW_OK);
  }
  EXPECT_EQ(h.push_moved(0, 0, 3 * kFrame, GST_BUFFER_FLAG_GAP), GST_FLOW_OK);
  gst_harness_push_event(h.harness(), gst_event_new_gap(4 * kFrame, kFrame));
  EXPECT_EQ(gst_harness_buffers_received(h.harness()), 4u);
  EXPECT_TRUE(h.motions().empty());
  ASSERT_EQ(h.warnings().size(), 1u);
  EXPECT_NE(h.warnings()[0].find("timestamp"), std::string::npos);
}

TEST_F(Time, TimestampsThatDifferByLittleOrNothingAreNotDividedBy) {
  for (const GstClockTime apart :
       {GstClockTime{0}, GstClockTime{1}, GstClockTime{100 * GST_USECOND}, kFrame / 8 - 1}) {
    SCOPED_TRACE(apart);
    ElementHarness frames;
    frames.set_caps(make_caps("GRAY8", 320, 240));
    frames.push_moved(0, 0, 0);
    frames.push_moved(2, 0, kFrame);
    frames.push_moved(3, 0, kFrame + apart);
    frames.push_moved(4, 0, 2 * kFrame);
    ASSERT_EQ(frames.motions().size(), 3u);
    // From the frame that was measured last, over the whole time since.
    EXPECT_NEAR(frames.motions()[2].velocity_x, 50, kTolerance_px / 0.04);
    EXPECT_EQ(frames.warnings().size(), 1u);
  }
}

TEST_F(Time, FramesAtEightTimesTheRateOfTheCapsAreFelt) {
  for (GstClockTime n = 0; n < 8; ++n)
    h.push_moved(0.25 * static_cast<double>(n), 0, n * kFrame / 8);
  EXPECT_EQ(h.motions().size(), 8u);
  EXPECT_TRUE(h.warnings().empty());
}

TEST_F(Time, AnAccurateSeekBetweenTwoFramesGivesNoWarning) {
  // Durations are rounded up in Matroska: two frames begin before the segment and reach into it.
  const auto push = [this](double dx, GstClockTime pts) {
    GstBuffer* frame = make_frame(h.info(), dx, 0);
    GST_BUFFER_DURATION(frame) = kFrame + GST_MSECOND;
    h.push(frame, pts);
  };
  for (const auto& [rate, later] :
       {std::pair{1.0, GstClockTime{0}}, {1.0, GstClockTime{GST_MSECOND}}, {-1.0, 0}}) {
    SCOPED_TRACE(rate);
    const size_t before = h.motions().size();
    flush(h);
    if (rate > 0) {
      send_segment(h, rate, 10 * kFrame);
      for (GstClockTime n = 9; n < 13; ++n) push(2.0 * static_cast<double>(n), n * kFrame + later);
    } else {
      send_segment(h, rate, 0, 10 * kFrame);
      for (GstClockTime n = 10; n >= 7; --n) {
        push(2.0 * static_cast<double>(n), n * kFrame - GST_USECOND);
      }
    }
    ASSERT_EQ(h.motions().size(), before + 4);
    EXPECT_EQ(h.motions()[before + 1].tracked, 0u) << "shown in place of the one before";
    EXPECT_NEAR(h.motions()[before + 2].velocity_x, rate * 50, kTolerance_px / 0.04);
  }
  EXPECT_TRUE(h.warnings().empty());
}

TEST_F(Time, OnlyTheFirstFrameOfASegmentIsReplaced) {
  for (int n = 0; n < 3; ++n) h.push_moved(n, 0, 0);
  EXPECT_EQ(h.motions().size(), 2u);
  EXPECT_EQ(h.warnings().size(), 1u);
}

TEST(Borders, TimesNearTheEndOfTheScaleDoNotOverflow) {
  // The undefined-behaviour sanitizer has the last word here. What is at most 73 years is felt.
  constexpr GstClockTime k73Years = GstClockTime{1} << 61;
  for (const GstClockTime border :
       {k73Years, GstClockTime{1} << 62, GstClockTime{G_MAXINT64}, GST_CLOCK_TIME_NONE - 1}) {
    SCOPED_TRACE(border);
    int64_t now_ns = 1'000'000'000;
    ElementHarness h("device=sim", [&] { return now_ns; });
    h.set_caps(make_caps("GRAY8", 64, 48));
    const GstClockTime base = border - 2 * kFrame;
    // Once by the base of the segment and once by the timestamps; there and back again.
    for (const auto& [segment_base, start] :
         {std::pair{base, GstClockTime{0}}, {0, 0}, {0, base}}) {
      send_segment(h, 1, start, GST_CLOCK_TIME_NONE, segment_base);
      const GstClockTime first = segment_base > 0 ? 0 : base;
      for (GstClockTime n = 0; n < 2; ++n) {
        EXPECT_EQ(h.push_moved(2.0 * static_cast<double>(n), 0, first + n * kFrame), GST_FLOW_OK);
        for (int ms = 0; ms < 3; ++ms) h.tick(now_ns += kTick_ns);
      }
      gst_harness_push_event(h.harness(), gst_event_new_gap(first + 2 * kFrame, kFrame));
      h.push_moved(0, 0, kFrame);
      for (const double multiplier : {1e-9, 0.5, 1.0, 1e9}) {
        for (const auto& [shown, upstream] : {std::pair{base, GstClockTime{0}}, {0, base}}) {
          h.state().feed.change_rate(multiplier, shown, upstream);
          h.push_moved(0, 0, first + kFrame);
          h.push_moved(2, 0, 2 * kFrame);
          h.tick(now_ns += kTick_ns);
        }
      }
    }
    gst_harness_push_event(h.harness(), gst_event_new_eos());
    const bool felt = std::any_of(
        h.motions().begin(), h.motions().end(),
        [base](const MotionMessage& m) { return m.running_time == base && m.features > 0; });
    EXPECT_EQ(felt, border <= k73Years);
  }
}

TEST_F(Time, FramesOutsideTheSegmentAreNotShownAndNotFelt) {
  send_segment(h, 1.0, 10 * kFrame, 20 * kFrame);
  h.push_moved(0, 0, 5 * kFrame);
  h.push_moved(2, 0, 10 * kFrame);
  EXPECT_EQ(h.motions().size(), 1u);
}

}  // namespace
}  // namespace spidar::test::time_test
