// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The objects on a frame, as elements of other projects read them.
#include <gst-spidar/gstspidarobjectmeta.h>
#include <gst/video/video.h>

#include "plugin/frame/object_metas.h"
#include "tests/support/element_harness.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

extern "C" GArray* read_objects_in_c(GstBuffer* buffer);

namespace spidar::test::object_metas_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 480, kHeight = 270;
constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr double kFrame_s = 0.04;
constexpr double kRadius_px = 30;
/// Blocks are 8 px of a picture this small; a box ends between two of them.
constexpr double kBlock_px = 8;

struct Region {
  std::string name;
  gint id;
  double x, y, width, height;
  Vector2d velocity_px_s, screen_px_s;
  double error_px_s;
  bool felt;
};

std::vector<Region> regions_of(GstBuffer* buffer) {
  std::vector<Region> regions;
  gpointer state = nullptr;
  while (GstMeta* const meta = gst_buffer_iterate_meta_filtered(
             buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* const region = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    Region read{g_quark_to_string(region->roi_type),
                region->id,
                static_cast<double>(region->x),
                static_cast<double>(region->y),
                static_cast<double>(region->w),
                static_cast<double>(region->h),
                {0, 0},
                {0, 0},
                0,
                false};
    gboolean felt = FALSE;
    const GstStructure* const motion =
        gst_video_region_of_interest_meta_get_param(region, "spidar-motion");
    if (motion) {
      gst_structure_get(motion, "velocity-x", G_TYPE_DOUBLE, &read.velocity_px_s.x(), "velocity-y",
                        G_TYPE_DOUBLE, &read.velocity_px_s.y(), "screen-velocity-x", G_TYPE_DOUBLE,
                        &read.screen_px_s.x(), "screen-velocity-y", G_TYPE_DOUBLE,
                        &read.screen_px_s.y(), "velocity-error", G_TYPE_DOUBLE, &read.error_px_s,
                        "felt", G_TYPE_BOOLEAN, &felt, nullptr);
    }
    read.felt = felt != FALSE;
    regions.push_back(read);
  }
  return regions;
}

/// One disc goes to the right, one down, in front of a camera that pans.
class ObjectMetas : public testing::Test {
 protected:
  ObjectMetas() {
    scene_.add_disc(kRadius_px);
    scene_.add_disc(kRadius_px);
  }
  void open(const std::string& properties) {
    h_ = std::make_unique<ElementHarness>("device=none motion=object " + properties);
    h_->set_caps(make_caps("GRAY8", kWidth, kHeight));
  }
  static std::vector<Placement> discs(int n) {
    return {{Vector2d(-150 + 4 * n, -60)}, {Vector2d(100, -60 + 3 * n)}};
  }
  GstBuffer* next() {
    const int n = frames_++;
    const ImageView picture = scene_.draw({kPan_px * n}, discs(n));
    GstBuffer* const frame =
        make_picture(h_->info(), [&](int x, int y) { return *picture.at(x, y); });
    gst_buffer_add_video_region_of_interest_meta(frame, "face", 1, 2, 3, 4);
    gst_buffer_add_video_region_of_interest_meta(frame, kObjectName, 5, 6, 7, 8);
    return h_->pass(frame, static_cast<GstClockTime>(n) * kFrame);
  }
  std::vector<Region> regions_after(int frames) {
    for (int n = 1; n < frames; ++n) gst_buffer_unref(next());
    GstBuffer* const out = next();
    const std::vector<Region> regions = regions_of(out);
    gst_buffer_unref(out);
    return regions;
  }

  static inline const Vector2d kPan_px{1, 0};
  MovingScene scene_{kWidth, kHeight};
  std::unique_ptr<ElementHarness> h_;
  int frames_ = 0;
};

TEST_F(ObjectMetas, HaveTheBoxAndTheVelocityOfEachObject) {
  open("attach-meta=true");
  const std::vector<Region> regions = regions_after(12);
  ASSERT_EQ(regions.size(), 3u) << "those of others stay, and two objects";
  EXPECT_EQ(regions[0].name, "face");
  int felt = 0;
  for (int disc = 0; disc < 2; ++disc) {
    const Vector2d middle_px =
        discs(11)[static_cast<size_t>(disc)].centre_px + Vector2d(kWidth, kHeight) / 2;
    const Vector2d step_px = disc == 0 ? Vector2d(4, 0) : Vector2d(0, 3);
    int found = 0;
    for (size_t i = 1; i < regions.size(); ++i) {
      const Region& region = regions[i];
      const Vector2d low_px(region.x, region.y), size_px(region.width, region.height);
      if ((low_px + size_px / 2 - middle_px).norm() > kRadius_px) continue;
      ++found;
      felt += region.felt;
      EXPECT_EQ(region.name, "spidar-object");
      EXPECT_GT(region.id, 0);
      for (const int axis : {0, 1}) {
        // The disc fills its box to the block at each side, and a pixel of rounding.
        EXPECT_NEAR(low_px[axis], middle_px[axis] - kRadius_px, kBlock_px + 1);
        EXPECT_NEAR(size_px[axis], 2 * kRadius_px, 2 * kBlock_px + 2);
      }
      // A tenth of the velocity: the blocks at the rim have a fraction of the background.
      const double off_px_s = 0.1 * step_px.norm() / kFrame_s;
      EXPECT_NEAR((region.screen_px_s - step_px / kFrame_s).norm(), 0, off_px_s);
      // The background goes to the right, too.
      EXPECT_NEAR((region.velocity_px_s - (step_px - kPan_px) / kFrame_s).norm(), 0, off_px_s);
      EXPECT_GT(region.error_px_s, 0);
      EXPECT_LT(region.error_px_s, step_px.norm() / kFrame_s);
    }
    EXPECT_EQ(found, 1) << disc;
  }
  EXPECT_EQ(felt, 1);
}

TEST_F(ObjectMetas, AreReadByAProgramInCAndByOurOwn) {
  open("attach-meta=true");
  for (int n = 1; n < 12; ++n) gst_buffer_unref(next());
  GstBuffer* const out = next();
  const std::vector<Region> regions = regions_of(out);
  GArray* const objects = read_objects_in_c(out);
  ASSERT_EQ(regions.size(), 3u);
  ASSERT_EQ(objects->len, 2u) << "not the face";
  const std::vector<ObjectBox> boxes = read_object_metas(out);
  ASSERT_EQ(boxes.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(boxes[i].name, regions[i].name);
    EXPECT_EQ(Vector2d(boxes[i].x, boxes[i].y), Vector2d(regions[i].x, regions[i].y));
    EXPECT_EQ(Vector2d(boxes[i].width, boxes[i].height),
              Vector2d(regions[i].width, regions[i].height));
  }
  for (guint i = 0; i < objects->len; ++i) {
    const auto& object = g_array_index(objects, GstSpidarObject, i);
    const Region& region = regions[i + 1];
    EXPECT_EQ(object.id, static_cast<guint>(region.id));
    EXPECT_EQ(Vector2d(object.x, object.y), Vector2d(region.x, region.y));
    EXPECT_EQ(Vector2d(object.w, object.h), Vector2d(region.width, region.height));
    EXPECT_EQ(Vector2d(object.frame_width, object.frame_height), Vector2d(kWidth, kHeight));
    EXPECT_EQ(Vector2d(object.velocity_x, object.velocity_y), region.velocity_px_s);
    EXPECT_EQ(Vector2d(object.screen_velocity_x, object.screen_velocity_y), region.screen_px_s);
    EXPECT_EQ(object.velocity_error, region.error_px_s);
    EXPECT_EQ(object.felt != FALSE, region.felt);
  }
  g_array_unref(objects);
  gst_buffer_unref(out);
  GstBuffer* const plain = gst_buffer_new();
  GArray* const none = read_objects_in_c(plain);
  EXPECT_EQ(none->len, 0u);
  g_array_unref(none);
  gst_buffer_unref(plain);
}

TEST_F(ObjectMetas, OfTheFeltObjectTheMessageHasTheErrorToo) {
  open("attach-meta=true");
  const std::vector<Region> regions = regions_after(12);
  double last_px_s = -1;
  while (GstMessage* const message = gst_bus_pop(GST_ELEMENT_BUS(h_->element()))) {
    if (gst_message_has_name(message, "spidar-motion"))
      gst_structure_get_double(gst_message_get_structure(message), "velocity-error", &last_px_s);
    gst_message_unref(message);
  }
  ASSERT_EQ(regions.size(), 3u);
  ASSERT_NE(regions[1].error_px_s, regions[2].error_px_s);
  EXPECT_EQ(last_px_s, regions[regions[1].felt ? 1 : 2].error_px_s);
}

TEST_F(ObjectMetas, AreThereOnlyWhenAskedFor) {
  open("");
  EXPECT_EQ(regions_after(12).size(), 2u) << "those that came with the frame";
}

}  // namespace
}  // namespace spidar::test::object_metas_test
