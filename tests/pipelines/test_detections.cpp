// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Boxes of GStreamer's analytics library, before the element and behind it.
#include <gst/analytics/analytics.h>
#include <gst/video/video.h>

#include "plugin/frame/object_metas.h"
#include "tests/pipelines/chosen_film.h"
#include "tests/support/test.h"

namespace spidar::test::detections_test {
namespace {

using Film = ChosenFilm;

constexpr int kFrames = 40;

/// As a detector does around a disc of 28 px.
void add_detection(GstBuffer* frame, const char* name, int disc, int n) {
  constexpr int kBox_px = 64;
  const Film::Vector2d corner_px =
      Film::disc_px(disc, n) + Film::Vector2d(Film::kWidth - kBox_px, Film::kHeight - kBox_px) / 2;
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(frame);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(frame);
  GstAnalyticsMtd detection;
  ASSERT_TRUE(gst_analytics_relation_meta_add_od_mtd(
      meta, g_quark_from_string(name), static_cast<gint>(corner_px.x()),
      static_cast<gint>(corner_px.y()), kBox_px, kBox_px, 0.7F, &detection));
}

TEST(Detections, ChooseTheObject) {
  for (const int disc : {0, 1, 2}) {
    SCOPED_TRACE(disc);
    Film film("feel=\"box face\"");
    film.attach_ = [&](GstBuffer* frame, int n) {
      add_detection(frame, "dog", (disc + 1) % Film::kDiscs, n);
      add_detection(frame, "face", disc, n);
    };
    film.play_to(Film::kKnown);
    int right = 0;
    for (int n = Film::kKnown; n < kFrames; ++n) {
      film.next();
      right += film.object_ != 0 && film.felt() == disc;
    }
    EXPECT_GE(right, Film::kMaxFrames * (kFrames - Film::kKnown));
    EXPECT_TRUE(film.warnings_.empty());
  }
}

/// Each object is a region, and a detection with the same box, whose track has the object's number.
/// Detections of others stay, and are no regions.
TEST(Detections, OfObjectsHaveTheirBoxAndNumber) {
  Film film("motion=object attach-meta=true");
  film.attach_ = [](GstBuffer* frame, int n) { add_detection(frame, "dog", 0, n); };
  film.play_to(kFrames);
  GstBuffer* frame = nullptr;
  while (GstBuffer* const next = gst_harness_try_pull(film.harness())) {
    gst_clear_buffer(&frame);
    frame = next;
  }
  ASSERT_NE(frame, nullptr);
  std::map<guint64, GstVideoRegionOfInterestMeta*> regions;
  gpointer state = nullptr;
  while (GstMeta* const meta = gst_buffer_iterate_meta_filtered(
             frame, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* const region = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    regions[static_cast<guint64>(region->id)] = region;
  }
  EXPECT_EQ(regions.size(), static_cast<size_t>(Film::kDiscs));
  GstAnalyticsRelationMeta* const meta = gst_buffer_get_analytics_relation_meta(frame);
  ASSERT_NE(meta, nullptr);
  int others = 0, ours = 0;
  GstAnalyticsMtd detection, track;
  for (gpointer at = nullptr; gst_analytics_relation_meta_iterate(
           meta, &at, gst_analytics_od_mtd_get_mtd_type(), &detection);) {
    if (gst_analytics_od_mtd_get_obj_type(&detection) != g_quark_from_static_string(kObjectName)) {
      ++others;
      continue;
    }
    ++ours;
    gpointer related = nullptr;
    ASSERT_TRUE(gst_analytics_relation_meta_get_direct_related(
        meta, detection.id, GST_ANALYTICS_REL_TYPE_RELATE_TO,
        gst_analytics_tracking_mtd_get_mtd_type(), &related, &track));
    guint64 id = 0;
    GstClockTime first = 0, last = 0;
    gboolean lost = TRUE;
    ASSERT_TRUE(gst_analytics_tracking_mtd_get_info(&track, &id, &first, &last, &lost));
    EXPECT_EQ(last, GST_BUFFER_PTS(frame));
    EXPECT_FALSE(lost);
    gint x = 0, y = 0, width = 0, height = 0;
    gfloat confidence = 0;
    ASSERT_TRUE(
        gst_analytics_od_mtd_get_location(&detection, &x, &y, &width, &height, &confidence));
    ASSERT_EQ(regions.count(id), 1u) << id;
    const GstVideoRegionOfInterestMeta& region = *regions[id];
    EXPECT_EQ(static_cast<guint>(x), region.x);
    EXPECT_EQ(static_cast<guint>(y), region.y);
    EXPECT_EQ(static_cast<guint>(width), region.w);
    EXPECT_EQ(static_cast<guint>(height), region.h);
    EXPECT_EQ(confidence, 1);
  }
  EXPECT_EQ(ours, Film::kDiscs);
  EXPECT_EQ(others, 1);
  EXPECT_EQ(read_object_metas(frame).size(), static_cast<size_t>(Film::kDiscs + 1))
      << "an object is read once";
  gst_buffer_unref(frame);
}

}  // namespace
}  // namespace spidar::test::detections_test
