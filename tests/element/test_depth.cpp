// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidardepth: frames and depth images in, frames with a meta out.
#include <string>
#include <thread>
#include <vector>

#include "depth_harness.h"

namespace spidar::test::depth_test {
namespace {

class Depth : public DepthHarness {};

TEST_F(Depth, AttachesAReferenceToTheImageAndLeavesTheFrameUnchanged) {
  GstBuffer* image = depth_image(0);
  gst_buffer_ref(image);
  push_depth({image});
  depth_thread.join();
  GstBuffer* frame = video_frame(0);
  GST_BUFFER_OFFSET(frame) = 17;
  GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_DISCONT);
  GstMemory* const memory = gst_buffer_peek_memory(frame, 0);
  ASSERT_EQ(gst_harness_push(video, frame), GST_FLOW_OK);
  GstBuffer* out = gst_harness_pull(video);
  EXPECT_EQ(gst_buffer_peek_memory(out, 0), memory);
  EXPECT_EQ(gst_buffer_memcmp(out, 0, std::string(16 * 48, 0x5a).data(), 16 * 48), 0);
  EXPECT_EQ(GST_BUFFER_PTS(out), 0u);
  EXPECT_EQ(GST_BUFFER_DURATION(out), kFrame);
  EXPECT_EQ(GST_BUFFER_OFFSET(out), 17u);
  EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(out, GST_BUFFER_FLAG_DISCONT));
  GstSpidarDepthImage found;
  ASSERT_TRUE(gst_buffer_get_spidar_depth(out, &found));
  EXPECT_EQ(found.buffer, image);
  EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&found.info), GST_VIDEO_FORMAT_GRAY16_LE);
  EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&found.info), 8);
  EXPECT_EQ(GST_VIDEO_INFO_HEIGHT(&found.info), 4);
  EXPECT_EQ(found.running_time, 0);
  EXPECT_FALSE(found.disparity) << "16 bits are a distance";
  EXPECT_LT(found.near_sample, 0);
  EXPECT_LT(found.far_sample, 0);

  // A copy has it too, a part of the bytes has not.
  GstBuffer* copy = gst_buffer_copy(out);
  EXPECT_TRUE(gst_buffer_get_spidar_depth(copy, &found));
  GstBuffer* part = gst_buffer_copy_region(out, GST_BUFFER_COPY_ALL, 0, 48);
  EXPECT_FALSE(gst_buffer_get_spidar_depth(part, &found));
  gst_buffer_unref(part);
  gst_buffer_unref(copy);
  gst_buffer_unref(out);
  gst_buffer_unref(image);
}

TEST_F(Depth, EventsOfTheVideoPassAndThoseOfTheDepthDoNot) {
  push_depth({depth_image(0)});
  depth_thread.join();
  GstTagList* tags = gst_tag_list_new(GST_TAG_TITLE, "film", nullptr);
  gst_harness_push_event(video, gst_event_new_tag(tags));
  push_video(1);
  gst_harness_push_event(video, gst_event_new_gap(kFrame, kFrame));
  gst_harness_push_event(video, gst_event_new_eos());
  std::vector<GstEventType> types;
  while (GstEvent* event = gst_harness_try_pull_event(video)) {
    types.push_back(GST_EVENT_TYPE(event));
    gst_event_unref(event);
  }
  EXPECT_EQ(types,
            (std::vector<GstEventType>{GST_EVENT_STREAM_START, GST_EVENT_CAPS, GST_EVENT_SEGMENT,
                                       GST_EVENT_TAG, GST_EVENT_GAP, GST_EVENT_EOS}));
}

TEST_F(Depth, SlowerDepthIsOnSeveralFrames) {
  push_depth(0, 5 * kFrame, 10);
  push_video(50);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 50u);
  for (size_t n = 0; n < 50; ++n) {
    EXPECT_EQ(all[n].pts, n * kFrame);
    ASSERT_TRUE(all[n].has_depth) << n;
    EXPECT_EQ(all[n].first_sample, static_cast<int>(n / 5 * 5));
  }
}

TEST_F(Depth, WithFasterDepthEachFrameHasItsOwn) {
  push_depth(0, kFrame / 4, 200);
  push_video(50);
  const std::vector<Shown> all = shown();
  for (size_t n = 0; n < 50; ++n) {
    EXPECT_EQ(all[n].depth.running_time, static_cast<gint64>(n * kFrame)) << n;
  }
}

TEST_F(Depth, WhileDepthIsMissingFramesPassWithoutIt) {
  open("max-age=80000000");
  push_depth({depth_image(0), depth_image(kFrame), depth_image(20 * kFrame)});
  push_video(25);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 25u);
  // The second ends with frame 1, and is kept for two frames more; the third likewise.
  for (size_t n = 0; n < 25; ++n) {
    EXPECT_EQ(all[n].has_depth, n <= 4 || (n >= 20 && n <= 23)) << n;
  }
}

TEST_F(Depth, OneImageIsUsedForeverIfAllowed) {
  open("max-age=18446744073709551615");
  push_depth({depth_image(0)});
  push_video(100);
  for (const Shown& one : shown()) EXPECT_TRUE(one.has_depth) << one.pts;
}

TEST_F(Depth, SizeAndFormatMayChangeBetweenImages) {
  depth_thread = std::thread([this] {
    gst_harness_push(depth, depth_image(0));
    gst_harness_set_src_caps_str(depth,
                                 "video/x-raw,format=GRAY8,width=4,height=100,framerate=25/1");
    gst_harness_push(depth, make_buffer(kFrame, 400, 7));
    gst_harness_set_src_caps_str(depth,
                                 "video/x-raw,format=GRAY16_BE,width=1,height=1,framerate=25/1");
    gst_harness_push(depth, make_buffer(2 * kFrame, 4, 9));
    gst_harness_push_event(depth, gst_event_new_eos());
  });
  push_video(3);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&all[0].depth.info), GST_VIDEO_FORMAT_GRAY16_LE);
  EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&all[1].depth.info), GST_VIDEO_FORMAT_GRAY8);
  EXPECT_EQ(GST_VIDEO_INFO_HEIGHT(&all[1].depth.info), 100);
  EXPECT_TRUE(all[1].depth.disparity) << "8 bits are a disparity";
  EXPECT_EQ(GST_VIDEO_INFO_FORMAT(&all[2].depth.info), GST_VIDEO_FORMAT_GRAY16_BE);
  EXPECT_EQ(all[2].first_sample, 9);
}

TEST_F(Depth, ChangedCapsOfTheVideoPass) {
  push_depth(0, kFrame, 4);
  push_video(2);
  gst_harness_set_src_caps_str(video, "video/x-raw,format=I420,width=64,height=2,framerate=25/1");
  ASSERT_EQ(gst_harness_push(video, make_buffer(2 * kFrame, 192, 1)), GST_FLOW_OK);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[2].has_depth);
  GstCaps* caps = gst_pad_get_current_caps(video->sinkpad);
  EXPECT_STREQ(gst_structure_get_string(gst_caps_get_structure(caps, 0), "format"), "I420");
  gst_caps_unref(caps);
}

}  // namespace
}  // namespace spidar::test::depth_test
