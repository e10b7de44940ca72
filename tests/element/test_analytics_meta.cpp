// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Detections and tracks of GstAnalyticsRelationMeta, in and out. Built with GStreamer 1.24 or
// newer.
#include <vector>

#include <gst/analytics/analytics.h>
#include <gtest/gtest.h>

#include "plugin/filter/frame/analytics_meta.h"

namespace spidar::test::analytics_meta_test {
namespace {

class AnalyticsMeta : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  ~AnalyticsMeta() override { gst_buffer_unref(buffer_); }

  guint add_detection(const char* name, gint x) {
    GstAnalyticsODMtd detection;
    EXPECT_TRUE(gst_analytics_relation_meta_add_od_mtd(meta(), g_quark_from_string(name), x, 20, 30,
                                                       40, 0.5F, &detection));
    return detection.id;
  }
  GstAnalyticsTrackingMtd add_track(guint64 id) {
    GstAnalyticsTrackingMtd track;
    EXPECT_TRUE(gst_analytics_relation_meta_add_tracking_mtd(meta(), id, 0, &track));
    return track;
  }
  void relate(guint from, guint to) {
    EXPECT_TRUE(gst_analytics_relation_meta_set_relation(meta(), GST_ANALYTICS_REL_TYPE_RELATE_TO,
                                                         from, to));
  }
  std::vector<ObjectBox> read() {
    std::vector<ObjectBox> boxes;
    read_analytics_meta(buffer_, boxes);
    return boxes;
  }
  GstAnalyticsRelationMeta* meta() {
    GstAnalyticsRelationMeta* const there = gst_buffer_get_analytics_relation_meta(buffer_);
    return there ? there : gst_buffer_add_analytics_relation_meta(buffer_);
  }

  GstBuffer* buffer_ = gst_buffer_new();
};

TEST_F(AnalyticsMeta, ADetectionIsABoxWithTheTrackThatItIsRelatedTo) {
  EXPECT_TRUE(read().empty()) << "no meta";
  const guint first = add_detection("person", -10), second = add_detection("dog", 10);
  add_detection("cat", 50);
  relate(first, add_track(0).id);
  relate(add_track(7).id, second);
  const std::vector<ObjectBox> boxes = read();
  ASSERT_EQ(boxes.size(), 3u);
  EXPECT_EQ(boxes[0].name, "person");
  EXPECT_EQ(boxes[0].x, -10);
  EXPECT_EQ(boxes[0].y, 20);
  EXPECT_EQ(boxes[0].width, 30);
  EXPECT_EQ(boxes[0].height, 40);
  EXPECT_EQ(boxes[0].track, 1u) << "0 stands for no track";
  EXPECT_EQ(boxes[1].name, "dog");
  EXPECT_EQ(boxes[1].track, 8u);
  EXPECT_EQ(boxes[2].track, 0u);
}

TEST_F(AnalyticsMeta, WhatATrackerHasLostIsNoBox) {
  const guint detection = add_detection("person", 10);
  GstAnalyticsTrackingMtd track = add_track(3);
  relate(detection, track.id);
  EXPECT_EQ(read().size(), 1u);
  gst_analytics_tracking_mtd_set_lost(&track);
  EXPECT_TRUE(read().empty());
}

TEST_F(AnalyticsMeta, OurObjectsAreDetectionsBesideThoseOfOthers) {
  attach_analytics_meta(buffer_, {});
  EXPECT_EQ(gst_buffer_get_analytics_relation_meta(buffer_), nullptr);
  add_detection("dog", 10);
  attach_analytics_meta(buffer_, {{kObjectName, 5, 1, 2, 3, 4}, {kObjectName, 6, 5, 6, 7, 8}});
  const std::vector<ObjectBox> boxes = read();
  ASSERT_EQ(boxes.size(), 3u);
  EXPECT_EQ(boxes[0].name, "dog");
  EXPECT_EQ(boxes[1].name, kObjectName);
  EXPECT_EQ(boxes[1].x, 1);
  EXPECT_EQ(boxes[2].height, 8);
  // The ids of tracks are our own ones.
  gpointer state = nullptr;
  GstAnalyticsTrackingMtd track;
  for (const guint64 wanted : {5u, 6u}) {
    guint64 id = 0;
    ASSERT_TRUE(gst_analytics_relation_meta_iterate(
        meta(), &state, gst_analytics_tracking_mtd_get_mtd_type(), &track));
    EXPECT_TRUE(gst_analytics_tracking_mtd_get_info(&track, &id, nullptr, nullptr, nullptr));
    EXPECT_EQ(id, wanted);
  }
}

}  // namespace
}  // namespace spidar::test::analytics_meta_test
