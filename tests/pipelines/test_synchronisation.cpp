// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The wrench of a frame acts at the moment at which the frame is shown. On a test clock, so nothing
// depends on the speed of the machine.
#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::synchronisation_test {
namespace {

const std::string kScene =
    "pattern=ball ! video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1 "
    "! spidarmotion name=motion ";

/// Checks that the ball is felt: otherwise the other checks would compare zero with zero.
void expect_something_felt(SteppedPipeline& pipeline) {
  double largest_N = 0;
  for (const auto& [time, wrench] : pipeline.wrenches()) {
    largest_N = std::max(largest_N, wrench.force_N.norm());
  }
  EXPECT_GT(largest_N, 0.1);
}

TEST(Synchronisation, OffsetMovesTheForceAndNotThePicture) {
  for (const GstClockTimeDiff offset : {20 * GST_MSECOND, -30 * GST_MSECOND}) {
    SCOPED_TRACE(offset);
    SteppedPipeline pipeline("videotestsrc " + kScene + kSink);
    g_object_set(pipeline.element(), "ts-offset", static_cast<gint64>(offset), nullptr);
    pipeline.set_state(GST_STATE_PLAYING);
    for (size_t n = 0; n < 5; ++n) {
      pipeline.await_analysed(n + 3);  // 30 ms ahead of the picture the next frame is needed
      const TickRecord tick = pipeline.step();
      EXPECT_EQ(tick.running_ns + pipeline.early_ns(),
                static_cast<int64_t>(pipeline.running_time()) - offset);
    }
    g_object_set(pipeline.element(), "ts-offset", static_cast<gint64>(0), nullptr);
    expect_wrench_of_frame(pipeline, pipeline.step());
  }
}

TEST(Synchronisation, TheForceMovesWithThePictureWhenTheSinkHasAnOffset) {
  // playbin's sinks are in bins too.
  SteppedPipeline pipeline(
      "videotestsrc " + kScene +
      "! queue name=queue bin.( fakesink name=sink sync=true ) queue. ! sink.");
  GstElement* const sink = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), "sink");
  ASSERT_NE(GST_OBJECT_PARENT(sink), GST_OBJECT_CAST(pipeline.pipeline()));
  for (const GstClockTimeDiff offset : {-30 * GST_MSECOND, 0 * GST_MSECOND, 100 * GST_MSECOND}) {
    SCOPED_TRACE(offset);
    g_object_set(sink, "ts-offset", static_cast<gint64>(offset), nullptr);
    pipeline.set_state(GST_STATE_PLAYING);
    pipeline.await_analysed(3);  // the first tick is up to 30 ms after the first frame's time
    pipeline.step();             // this one the sink was waiting for already
    for (int n = 0; n < 5; ++n) expect_wrench_of_frame(pipeline, pipeline.step());
  }
  gst_object_unref(sink);
  expect_something_felt(pipeline);
}

}  // namespace
}  // namespace spidar::test::synchronisation_test
