// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The meta on a frame, read as a C program reads it.
#include <gst-spidar/gstspidarmotionmeta.h>

#include "plugin/filter/reports/motion_meta.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

extern "C" {
gboolean read_motion_in_c(GstBuffer* buffer, GstSpidarFrameMotion* motion);
GArray* read_tracks_in_c(GstBuffer* buffer);
}

namespace spidar::test::meta_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

std::vector<GstSpidarMotionPoint> points_of(GstBuffer* buffer) {
  std::vector<GstSpidarMotionPoint> points;
  GArray* array = read_tracks_in_c(buffer);
  if (!array) return points;
  for (guint i = 0; i < array->len; ++i) {
    points.push_back(g_array_index(array, GstSpidarMotionPoint, i));
  }
  g_array_unref(array);
  return points;
}

class Meta : public testing::Test {
 protected:
  void open(const std::string& properties) {
    h = std::make_unique<ElementHarness>("device=none " + properties);
    h->set_caps(make_caps("I420", 320, 240));
  }

  /// The output for the next frame, which is moved by (3, −1) pixels.
  GstBuffer* push_next(GstBuffer** pushed = nullptr) {
    const int n = frames++;
    GstBuffer* frame = make_frame(h->info(), 3.0 * n, -1.0 * n);
    if (pushed) *pushed = gst_buffer_ref(frame);
    return h->pass(frame, static_cast<GstClockTime>(n) * kFrame);
  }

  std::unique_ptr<ElementHarness> h;
  int frames = 0;
};

TEST_F(Meta, HasTheValuesOfTheMessageAndTheTracks) {
  open("attach-meta=true");
  GstBuffer* out = push_next();
  GstSpidarFrameMotion motion;
  ASSERT_TRUE(read_motion_in_c(out, &motion));
  EXPECT_EQ(motion.interval, 0u) << "there is nothing to compare the first one with";
  EXPECT_TRUE(points_of(out).empty());
  gst_buffer_unref(out);
  out = push_next();
  ASSERT_TRUE(read_motion_in_c(out, &motion));
  const MotionMessage& message = h->motions().back();
  EXPECT_EQ(motion.width, 320u);
  EXPECT_EQ(motion.height, 240u);
  EXPECT_EQ(motion.running_time, kFrame);
  EXPECT_EQ(motion.interval, kFrame);
  EXPECT_EQ(motion.velocity_x, message.velocity_x);
  EXPECT_EQ(motion.velocity_y, message.velocity_y);
  EXPECT_EQ(motion.force_x, message.wrench.force_N.x());
  EXPECT_EQ(motion.force_y, message.wrench.force_N.y());
  EXPECT_EQ(motion.torque_z, message.wrench.torque_Nm.z());
  const auto points = points_of(out);
  EXPECT_EQ(points.size(), message.tracked);
  EXPECT_GT(points.size(), 20u);
  for (const GstSpidarMotionPoint& point : points) {
    EXPECT_NEAR(point.to_x - point.from_x, 3, 0.5) << point.id;
    EXPECT_NEAR(point.to_y - point.from_y, -1, 0.5) << point.id;
  }
  gst_buffer_unref(out);
}

TEST_F(Meta, SaysWhichFramesRepeatThePictureBefore) {
  open("attach-meta=true");
  const std::array<double, 5> moved_px{0, 3, 3, 6, 6};
  for (size_t n = 0; n < moved_px.size(); ++n) {
    GstBuffer* const out = h->pass(make_frame(h->info(), moved_px[n], 0), n * kFrame);
    const bool repeated = n > 0 && moved_px[n] == moved_px[n - 1];
    EXPECT_EQ(gst_buffer_repeats_spidar_motion(out) != FALSE, repeated) << n;
    EXPECT_EQ(h->motions().back().repeated, repeated) << n;
    gst_buffer_unref(out);
  }
}

TEST_F(Meta, NeitherCopiesNorTouchesThePicture) {
  open("attach-meta=true");
  GstBuffer* frame;
  GstBuffer* out = push_next(&frame);  // held by somebody else: not writable
  EXPECT_NE(out, frame);
  EXPECT_EQ(gst_buffer_peek_memory(out, 0), gst_buffer_peek_memory(frame, 0));
  GstSpidarFrameMotion motion;
  EXPECT_FALSE(read_motion_in_c(frame, &motion)) << "not ours to change";
  EXPECT_EQ(read_tracks_in_c(frame), nullptr);
  EXPECT_TRUE(read_motion_in_c(out, &motion));
  gst_buffer_unref(out);
  gst_buffer_unref(frame);

  GstBuffer* mine = make_frame(h->info(), 3, 0);
  out = h->pass(mine, kFrame);
  EXPECT_EQ(out, mine) << "a buffer that nobody else holds stays the same";
  gst_buffer_unref(out);
}

TEST_F(Meta, IsThereOnlyWhenAskedForAndWithTheOverlayToo) {
  open("");
  GstSpidarFrameMotion motion;
  for (const auto& [meta, overlay] :
       {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
    g_object_set(h->element(), "attach-meta", meta, "overlay", overlay, nullptr);
    GstBuffer* out = push_next();
    EXPECT_EQ(read_motion_in_c(out, &motion) != FALSE, meta);
    gst_buffer_unref(out);
  }
}

TEST_F(Meta, ReplacesTheMetaOfAnEarlierElement) {
  open("attach-meta=true");
  GstBuffer* first = push_next();
  GstBuffer* frame = gst_buffer_copy_deep(first);
  gst_buffer_unref(first);
  GstBuffer* out = h->pass(frame, kFrame);
  gpointer state = nullptr;
  int metas = 0;
  while (GstMeta* meta = gst_buffer_iterate_meta(out, &state)) {
    metas += gst_meta_info_is_custom(meta->info) != FALSE;
  }
  EXPECT_EQ(metas, 1);
  GstSpidarFrameMotion motion;
  read_motion_in_c(out, &motion);
  EXPECT_EQ(motion.running_time, kFrame);
  gst_buffer_unref(out);
}

TEST_F(Meta, IsCopiedWithAFrameButNotWithAPartOfIt) {
  open("attach-meta=true");
  gst_buffer_unref(push_next());
  GstBuffer* out = push_next();
  GstBuffer* copy = gst_buffer_copy(out);
  GstBuffer* part = gst_buffer_copy_region(
      out, static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_META | GST_BUFFER_COPY_MEMORY), 100,
      100);
  GstSpidarFrameMotion a, b;
  ASSERT_TRUE(read_motion_in_c(out, &a));
  ASSERT_TRUE(read_motion_in_c(copy, &b));
  EXPECT_EQ(a.velocity_x, b.velocity_x);
  EXPECT_EQ(points_of(out).size(), points_of(copy).size());
  EXPECT_FALSE(read_motion_in_c(part, &b));
  gst_buffer_unref(part);
  gst_buffer_unref(copy);
  gst_buffer_unref(out);
}

/// What videocrop and videoflip of GStreamer 1.28 do.
class MappedMeta : public Meta {
 protected:
  void SetUp() override {
    open("attach-meta=true");
    gst_buffer_unref(push_next());
    frame_ = push_next();
    ASSERT_TRUE(read_motion_in_c(frame_, &before_));
  }
  void TearDown() override { gst_buffer_unref(frame_); }

  using Matrix = std::array<std::array<float, 3>, 3>;

  /// Puts into `to` the meta of the frame that is made from that part of this one by `matrix`;
  /// returns false when there is none.
  bool transform(GstBuffer* to, const GstVideoRectangle& part, int width, int height,
                 const Matrix& matrix) {
    GstVideoInfo out;
    gst_video_info_set_format(&out, GST_VIDEO_FORMAT_I420, static_cast<guint>(width),
                              static_cast<guint>(height));
    filter::MatrixTransform data{&h->info(), part, &out, {0, 0, width, height}, {}};
    for (size_t row = 0; row < 3; ++row)
      std::copy(matrix[row].begin(), matrix[row].end(), data.matrix[row]);
    GstCustomMeta* const meta = gst_buffer_get_custom_meta(frame_, GST_SPIDAR_MOTION_META_NAME);
    const GstMetaInfo* const info = gst_meta_get_info(GST_SPIDAR_MOTION_META_NAME);
    return info->transform_func(to, reinterpret_cast<GstMeta*>(meta), frame_,
                                filter::matrix_transform(), &data) != FALSE;
  }

  /// Its motion.
  GstSpidarFrameMotion map(const GstVideoRectangle& part, int width, int height,
                           const Matrix& matrix) {
    GstBuffer* const to = gst_buffer_new();
    EXPECT_TRUE(transform(to, part, width, height, matrix));
    GstSpidarFrameMotion motion{};
    EXPECT_TRUE(read_motion_in_c(to, &motion));
    EXPECT_EQ(motion.width, static_cast<guint>(width));
    EXPECT_EQ(motion.height, static_cast<guint>(height));
    points_ = points_of(to);
    gst_buffer_unref(to);
    return motion;
  }

  GstBuffer* frame_ = nullptr;
  GstSpidarFrameMotion before_{};
  std::vector<GstSpidarMotionPoint> points_;
};

TEST_F(MappedMeta, CroppingMovesPlacesAndNothingElse) {
  const GstSpidarFrameMotion after =
      map({30, 20, 280, 200}, 280, 200, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  EXPECT_NEAR(after.velocity_x, before_.velocity_x, 1e-9);
  EXPECT_NEAR(after.force_x, before_.force_x, 1e-9);
  EXPECT_NEAR(after.force_y, before_.force_y, 1e-9);
  EXPECT_NEAR(after.torque_z, before_.torque_z, 1e-9);
  const auto before = points_of(frame_);
  ASSERT_EQ(points_.size(), before.size());
  EXPECT_GT(points_.size(), 20u);
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(points_[i].to_x, before[i].to_x - 30, 1e-9);
    EXPECT_NEAR(points_[i].from_y, before[i].from_y - 20, 1e-9);
  }
}

TEST_F(MappedMeta, MirroringMirrorsDirectionsAndTurnsRotationsRound) {
  const GstSpidarFrameMotion after =
      map({0, 0, 320, 240}, 320, 240, {{{-1, 0, 320}, {0, 1, 0}, {0, 0, 1}}});
  EXPECT_NEAR(after.velocity_x, -before_.velocity_x, 1e-9);
  EXPECT_NEAR(after.velocity_y, before_.velocity_y, 1e-9);
  EXPECT_GT(std::abs(before_.force_x), 0.01);
  EXPECT_NEAR(after.force_x, -before_.force_x, 1e-9);
  EXPECT_NEAR(after.force_y, before_.force_y, 1e-9);
  EXPECT_NEAR(after.torque_z, -before_.torque_z, 1e-9);
  EXPECT_NEAR(after.roll, -before_.roll, 1e-9);
  // The centre of the first pixel is that of the last one then.
  for (const auto& point : points_of(frame_)) EXPECT_GE(point.to_x, -0.5);
  EXPECT_NEAR(points_[0].to_x, 319 - points_of(frame_)[0].to_x, 1e-9);
}

TEST_F(MappedMeta, TurningClockwiseTurnsTheForceAsMuch) {
  const GstSpidarFrameMotion after =
      map({0, 0, 320, 240}, 240, 320, {{{0, -1, 240}, {1, 0, 0}, {0, 0, 1}}});
  EXPECT_NEAR(after.velocity_x, -before_.velocity_y, 1e-9);
  EXPECT_NEAR(after.velocity_y, before_.velocity_x, 1e-9);
  // To the right becomes down, and up becomes to the right.
  EXPECT_NEAR(after.force_x, before_.force_y, 1e-9);
  EXPECT_NEAR(after.force_y, -before_.force_x, 1e-9);
  EXPECT_NEAR(after.torque_z, before_.torque_z, 1e-9);
}

/// Such a picture has no directions; a meta of it would have numbers that are none.
TEST_F(MappedMeta, IsNotKeptWhereTheMapIsSingularOrInfinite) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  for (const Matrix& matrix :
       {Matrix{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, Matrix{{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}},
        Matrix{{{1, 2, 0}, {2, 4, 0}, {0, 0, 1}}}, Matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}},
        Matrix{{{kNone, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        Matrix{{{kEndless, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        Matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, kEndless}}}}) {
    GstBuffer* const to = gst_buffer_new();
    EXPECT_FALSE(transform(to, {0, 0, 320, 240}, 320, 240, matrix)) << matrix[0][0];
    EXPECT_FALSE(gst_buffer_get_custom_meta(to, GST_SPIDAR_MOTION_META_NAME));
    gst_buffer_unref(to);
  }
}

}  // namespace
}  // namespace spidar::test::meta_test
