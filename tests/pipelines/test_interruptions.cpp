// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Interruptions of a film: pauses, frame steps, new clocks, new latencies. On a test clock.
#include <gst/app/gstappsrc.h>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::interruptions_test {
namespace {

constexpr GstClockTime kMinute = 60 * GST_SECOND;

/// Checks that frames from here on are in time, and felt.
void expect_motion(SteppedPipeline& pipeline, int frames) {
  for (const Eigen::Vector3d& felt_px_s : play(pipeline, frames)) {
    EXPECT_GT(felt_px_s.norm(), kMoves_px_s);
  }
}

TEST(Interruptions, PausedForAMinute) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 10);
  pipeline.set_state(GST_STATE_PAUSED);
  expect_rest(pipeline, 50 * GST_MSECOND);
  expect_rest(pipeline, kMinute);
  pipeline.set_state(GST_STATE_PLAYING);
  EXPECT_EQ(pipeline.running_time(), 9 * kFrame) << "the minute is no time of the film's";
  expect_motion(pipeline, 10);
}

TEST(Interruptions, PausedBeforeTheFirstFrame) {
  SteppedPipeline pipeline("appsrc name=source format=time " + kMotion + kSink);
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), "source");
  GstCaps* caps = make_caps("GRAY8", 320, 240);
  GstVideoInfo info;
  gst_video_info_from_caps(&info, caps);
  gst_app_src_set_caps(GST_APP_SRC(source), caps);
  gst_caps_unref(caps);
  // Neither state is reached: there is nothing to show.
  EXPECT_EQ(gst_element_set_state(pipeline.pipeline(), GST_STATE_PLAYING), GST_STATE_CHANGE_ASYNC);
  expect_rest(pipeline, GST_SECOND);
  EXPECT_EQ(gst_element_set_state(pipeline.pipeline(), GST_STATE_PAUSED), GST_STATE_CHANGE_ASYNC);
  for (int n = 0; n < 10; ++n) {
    GstBuffer* frame = make_frame(info, 4.0 * n, 0);
    GST_BUFFER_PTS(frame) = static_cast<GstClockTime>(n) * kFrame;
    gst_app_src_push_buffer(GST_APP_SRC(source), frame);
  }
  gst_object_unref(source);
  pipeline.await_analysed(10);
  expect_rest(pipeline, kMinute);
  pipeline.set_state(GST_STATE_PLAYING);
  EXPECT_EQ(play(pipeline, 1)[0].norm(), 0);
  expect_motion(pipeline, 9);
}

/// After a sink has stepped over frames, it shows later ones earlier: the force is still that of
/// the frame that is shown.
void expect_motion_of_what_is_shown(SteppedPipeline& pipeline, int frames) {
  for (int n = 0; n < frames; ++n) {
    const TickRecord tick = pipeline.step();
    SCOPED_TRACE(pipeline.shown());
    EXPECT_LT(pipeline.running_time(), pipeline.shown());
    expect_wrench_of(pipeline, tick, pipeline.shown());
    EXPECT_GT(velocity_px_s(tick.wanted.force_N).norm(), kMoves_px_s);
  }
}

TEST(Interruptions, FrameByFrameNothingIsFeltAndAfterwardsItIsInTime) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 5);
  pipeline.set_state(GST_STATE_PAUSED);
  expect_rest(pipeline, 50 * GST_MSECOND);
  for (int n = 0; n < 3; ++n) {
    pipeline.step_frames(1);
    expect_rest(pipeline, GST_SECOND);
  }
  pipeline.set_state(GST_STATE_PLAYING);
  expect_motion_of_what_is_shown(pipeline, 10);
  // Once more, on top of it; and a seek, which begins anew.
  pipeline.set_state(GST_STATE_PAUSED);
  pipeline.step_frames(4);
  pipeline.set_state(GST_STATE_PLAYING);
  expect_motion_of_what_is_shown(pipeline, 10);
  pipeline.seek(GST_SECOND);
  play(pipeline, 1);
  expect_motion(pipeline, 5);
}

TEST(Interruptions, FrameByFrameAtOtherSpeeds) {
  for (const double rate : {0.5, 2.0, -1.0}) {
    SCOPED_TRACE(rate);
    SteppedPipeline pipeline(kPlayer);
    pipeline.set_state(GST_STATE_PAUSED);
    pipeline.seek(rate, GST_SEEK_FLAG_FLUSH, 0, 4 * GST_SECOND);
    pipeline.set_state(GST_STATE_PLAYING);
    play(pipeline, 5);
    pipeline.set_state(GST_STATE_PAUSED);
    pipeline.step_frames(3);
    pipeline.set_state(GST_STATE_PLAYING);
    expect_motion_of_what_is_shown(pipeline, 10);
  }
}

TEST(Interruptions, AStepWhilePlaying) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 5);
  pipeline.step_frames(3);
  expect_motion_of_what_is_shown(pipeline, 10);
}

/// Writes the first 100 frames of such a pipeline.
void write_film(const std::string& launch) {
  init_gstreamer();
  GstElement* pipeline = gst_parse_launch(launch.c_str(), nullptr);
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline), "source");
  g_object_set(source, "num-buffers", 100, nullptr);
  gst_object_unref(source);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  gst_message_unref(gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

TEST(Interruptions, OnlyKeyUnitsAreShown) {
  const TemporaryFolder folder;
  const std::string film = (folder.path / "film.webm").string();
  // A key frame every five.
  write_film(
      kBall +
      "! videoconvert ! vp8enc deadline=1 keyframe-max-dist=5 ! webmmux ! filesink location=" +
      film);
  SteppedPipeline pipeline("filesrc location=" + film + " ! matroskademux ! vp8dec " + kMotion +
                           kSink);
  pipeline.set_state(GST_STATE_PAUSED);
  pipeline.seek(4.0,
                GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_TRICKMODE | GST_SEEK_FLAG_TRICKMODE_KEY_UNITS,
                0, 4 * GST_SECOND);
  pipeline.set_state(GST_STATE_PLAYING);
  const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 10);
  EXPECT_EQ(pipeline.running_time(), 9 * 5 * kFrame / 4);
  // The demuxer marks the second frame as a discontinuity, too. Five frames in 50 ms.
  for (size_t n = 2; n < 10; ++n) EXPECT_GT(felt_px_s[n].norm(), 4 * kMoves_px_s) << n;
}

TEST(Interruptions, AnotherLatencyWhilePlaying) {
  SteppedPipeline pipeline(
      "videotestsrc is-live=true pattern=ball ! "
      "video/x-raw,format=GRAY8,width=320,height=240,framerate=25/1 " +
      kMotion + "! queue ! fakesink name=sink sync=true processing-deadline=100000000");
  pipeline.play_live();
  pipeline.step();  // the source takes the first frame, which is shown 100 ms later
  for (const int latency_ms : {100, 180, 60}) {
    SCOPED_TRACE(latency_ms);
    g_object_set(pipeline.sink(), "processing-deadline", latency_ms * GST_MSECOND, nullptr);
    gst_bin_recalculate_latency(GST_BIN(pipeline.pipeline()));
    // What was in the sink at the change has waited for the old time.
    for (int n = 0; n < 20; ++n) pipeline.step(2);
    int shown = 0;
    for (int n = 0; n < 20; ++n) {
      const TickRecord tick = pipeline.step(2);
      EXPECT_EQ(tick.running_ns + pipeline.early_ns(),
                static_cast<int64_t>(pipeline.running_time()));
      if (pipeline.shown() != pipeline.running_time()) continue;  // a frame for the source
      ++shown;
      expect_wrench_of(pipeline, tick, pipeline.shown());
    }
    EXPECT_GE(shown, 5);
  }
}

TEST(Interruptions, AnotherBaseTimeWhilePlaying) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 10);
  // The film is to be shown so much later from now on: what a pipeline does that follows another.
  constexpr GstClockTime kLater = 300 * GST_MSECOND;
  pipeline.await();
  const GstClockTime base_time = gst_element_get_base_time(pipeline.pipeline()) + kLater;
  for (GstElement* element : {pipeline.pipeline(), pipeline.element(), pipeline.sink()}) {
    gst_element_set_base_time(element, base_time);
  }
  pipeline.step();  // the sink has waited for the old time
  expect_motion(pipeline, 10);
}

TEST(Interruptions, AClockThatIsLostAndReplaced) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 10);
  // One that was started long ago, and one that has only just been.
  for (const GstClockTime start : {400'000 * GST_SECOND, GST_SECOND}) {
    pipeline.replace_clock(start);
    expect_motion(pipeline, 10);
  }
}

}  // namespace
}  // namespace spidar::test::interruptions_test
