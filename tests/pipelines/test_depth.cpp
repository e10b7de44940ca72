// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Video and depth from two sources that run as fast as possible, with the plugin as GStreamer loads
// it.
#include <string>

#include <gst-spidar/gstspidardepthmeta.h>
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

namespace spidar::test::depth_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

class DepthPipeline : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  /// `rate` of the depth, in images a second.
  void open(int frames, int images, int rate, const std::string& behind_depth = "") {
    GError* error = nullptr;
    pipeline = gst_parse_launch(
        ("spidardepth name=d ! appsink name=out sync=false max-buffers=1 "
         "videotestsrc num-buffers=" +
         std::to_string(frames) +
         " ! video/x-raw,format=I420,width=64,height=48,framerate=25/1 ! queue ! d.sink "
         "videotestsrc num-buffers=" +
         std::to_string(images) + " ! video/x-raw,format=GRAY16_BE,width=32,height=20,framerate=" +
         std::to_string(rate) + "/1 ! " + behind_depth + " queue ! d.depth_sink")
            .c_str(),
        &error);
    ASSERT_EQ(error, nullptr) << error->message;
    sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
  }
  void TearDown() override {
    if (!pipeline) return;
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(sink);
    gst_object_unref(pipeline);
    pipeline = nullptr;
  }

  void set_state(GstState state) {
    gst_element_set_state(pipeline, state);
    ASSERT_NE(gst_element_get_state(pipeline, nullptr, nullptr, 60 * GST_SECOND),
              GST_STATE_CHANGE_FAILURE);
  }

  /// Running time of the frame and of its depth, −1 without depth.
  static std::pair<gint64, gint64> times(GstSample* sample) {
    GstBuffer* frame = gst_sample_get_buffer(sample);
    GstSpidarDepthImage depth;
    const bool found = gst_buffer_get_spidar_depth(frame, &depth) != FALSE;
    const guint64 shown = gst_segment_to_running_time(gst_sample_get_segment(sample),
                                                      GST_FORMAT_TIME, GST_BUFFER_PTS(frame));
    return {static_cast<gint64>(shown), found ? depth.running_time : -1};
  }

  /// Checks the frames up to the end, each with depth that is not older than `period_ns`; returns
  /// their number.
  int play_to_end(gint64 period_ns) {
    int frames = 0;
    while (GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink))) {
      const auto [frame, depth] = times(sample);
      gst_sample_unref(sample);
      EXPECT_GE(depth, 0) << frame;
      EXPECT_LE(depth, frame);
      EXPECT_GT(depth + period_ns, frame);
      ++frames;
    }
    return frames;
  }

  GstElement* pipeline = nullptr;
  GstElement* sink = nullptr;
};

TEST_F(DepthPipeline, EveryFrameHasTheDepthOfItsTime) {
  for (const int rate : {25, 5, 50}) {
    open(100, 4 * rate, rate);
    set_state(GST_STATE_PLAYING);
    EXPECT_EQ(play_to_end(GST_SECOND / rate), 100) << rate;
    TearDown();
  }
}

TEST_F(DepthPipeline, AStillImageServesTheWholeFilm) {
  open(100, 1, 25, "imagefreeze !");
  set_state(GST_STATE_PLAYING);
  EXPECT_EQ(play_to_end(2 * kFrame), 100);
}

TEST_F(DepthPipeline, AfterASeekTheFirstFrameHasItsDepthToo) {
  open(100000, 100000, 25);
  set_state(GST_STATE_PAUSED);
  for (const GstClockTime to : {3000, 7, 2000, 0, 3600}) {
    ASSERT_TRUE(gst_element_seek_simple(
        pipeline, GST_FORMAT_TIME,
        static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE),
        static_cast<gint64>(to * kFrame)));
    ASSERT_EQ(gst_element_get_state(pipeline, nullptr, nullptr, 60 * GST_SECOND),
              GST_STATE_CHANGE_SUCCESS);
    GstSample* sample = gst_app_sink_pull_preroll(GST_APP_SINK(sink));
    ASSERT_NE(sample, nullptr);
    EXPECT_EQ(GST_BUFFER_PTS(gst_sample_get_buffer(sample)), to * kFrame);
    const auto [frame, depth] = times(sample);
    EXPECT_EQ(frame, 0);
    EXPECT_EQ(depth, 0) << "after the seek to frame " << to;
    gst_sample_unref(sample);
  }
}

TEST_F(DepthPipeline, BackwardsTooTheDepthIsThatOfTheFrame) {
  open(100000, 100000, 25);
  set_state(GST_STATE_PAUSED);
  ASSERT_TRUE(gst_element_seek(pipeline, -1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                               GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_SET, 20 * kFrame));
  set_state(GST_STATE_PLAYING);
  int frames = 0;
  while (GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink))) {
    GstBuffer* frame = gst_sample_get_buffer(sample);
    GstSpidarDepthImage depth;
    ASSERT_TRUE(gst_buffer_get_spidar_depth(frame, &depth));
    EXPECT_EQ(GST_BUFFER_PTS(depth.buffer), GST_BUFFER_PTS(frame));
    gst_sample_unref(sample);
    ++frames;
  }
  EXPECT_GE(frames, 20);
}

// videoflip is not asked: that of GStreamer 1.22 hands metas on as if it scaled the picture.
TEST_F(DepthPipeline, ConvertersKeepTheDepthAndCroppingDropsIt) {
  for (const auto& [filter, kept] : {std::pair{"videoconvert ! video/x-raw,format=RGB", true},
                                     {"videoscale ! video/x-raw,width=640,height=480", true},
                                     {"videocrop left=16", false}}) {
    GError* error = nullptr;
    pipeline = gst_parse_launch((std::string("spidardepth name=d ! ") + filter +
                                 " ! appsink name=out sync=false "
                                 "videotestsrc num-buffers=3 ! queue ! d.sink videotestsrc "
                                 "num-buffers=3 ! video/x-raw,format=GRAY8 ! queue ! d.depth_sink")
                                    .c_str(),
                                &error);
    ASSERT_EQ(error, nullptr) << error->message;
    sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
    set_state(GST_STATE_PLAYING);
    GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink));
    ASSERT_NE(sample, nullptr) << filter;
    EXPECT_EQ(times(sample).second >= 0, kept) << filter;
    gst_sample_unref(sample);
    TearDown();
  }
}

TEST_F(DepthPipeline, WithoutDepthTheVideoPasses) {
  pipeline = gst_parse_launch(
      "videotestsrc num-buffers=10 ! spidardepth ! appsink name=out sync=false", nullptr);
  sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
  set_state(GST_STATE_PLAYING);
  int frames = 0;
  while (GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink))) {
    EXPECT_EQ(times(sample).second, -1);
    gst_sample_unref(sample);
    ++frames;
  }
  EXPECT_EQ(frames, 10);
}

}  // namespace
}  // namespace spidar::test::depth_test
