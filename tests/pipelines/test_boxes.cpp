// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A detector before the element chooses by its boxes what is felt.
#include <gst/video/video.h>

#include "tests/pipelines/chosen_film.h"
#include "tests/support/test.h"

namespace spidar::test::boxes_test {
namespace {

using Eigen::Vector2d;
using Film = ChosenFilm;

/// Larger than the discs, whose radius is 28 px.
constexpr int kBox_px = 64;

/// As detectors and trackers do, in pixels of the frame that comes to them.
void add_region(GstBuffer* frame, const char* name, int disc, int n) {
  const Vector2d corner_px =
      Film::disc_px(disc, n) + Vector2d(Film::kWidth - kBox_px, Film::kHeight - kBox_px) / 2;
  // Left of the picture, cvtracker stores negative numbers.
  gst_buffer_add_video_region_of_interest_meta(
      frame, name, static_cast<guint>(static_cast<gint>(corner_px.x())),
      static_cast<guint>(static_cast<gint>(corner_px.y())), kBox_px, kBox_px);
}

/// Fraction of the frames in which the disc is felt alone, once objects are known.
double fraction_felt(Film& film, int disc) {
  constexpr int kFrames = 40;
  film.play_to(Film::kKnown);
  int right = 0;
  for (int n = Film::kKnown; n < kFrames; ++n) {
    film.next();
    right += film.object_ != 0 && film.felt() == disc;
  }
  return static_cast<double>(right) / (kFrames - Film::kKnown);
}

TEST(Boxes, TheNamedOneChoosesTheObject) {
  Film film("feel=\"box face\"");
  film.attach_ = [&](GstBuffer* frame, int n) {
    add_region(frame, "dog", 0, n);
    add_region(frame, "face", 2, n);
  };
  EXPECT_GE(fraction_felt(film, 2), Film::kMaxFrames);
  EXPECT_TRUE(film.warnings_.empty());
}

TEST(Boxes, AreScaledByTheScalerBeforeUs) {
  Film film("feel=box", "", "videoscale ! video/x-raw,width=320,height=180 ! ");
  film.attach_ = [](GstBuffer* frame, int n) { add_region(frame, "face", 2, n); };
  film.play_to(40);
  EXPECT_NE(film.object_, 0u);
  // Its own velocity, to the left, in pixels that are larger by half. A third of it is 25 px/s;
  // the other discs go to the right, or down.
  EXPECT_NEAR(film.velocity_px_s_.x(), Film::kStep_px[2].x() / Film::kFrame_s * 2 / 3, 25);
  EXPECT_NEAR(film.velocity_px_s_.y(), 0, 25);
  EXPECT_TRUE(film.warnings_.empty());
}

TEST(Boxes, OfACroppedFrameAreThoseOfTheWholeOne) {
  Film film("feel=box");
  film.attach_ = [](GstBuffer* frame, int n) {
    add_region(frame, "face", 0, n);
    GstVideoCropMeta* const crop = gst_buffer_add_video_crop_meta(frame);
    crop->x = crop->y = 0;
    crop->width = Film::kWidth * 3 / 4;
    crop->height = Film::kHeight;
  };
  EXPECT_GE(fraction_felt(film, 0), Film::kMaxFrames);
}

TEST(Boxes, ThatAreMissingOrEmptyAreNamedOnceAndNothingIsFelt) {
  const std::pair<const char*, const char*> rules[] = {
      {"box", "feel, line 1: no frame comes with a box."},
      {"box \\\"red car\\\"", "feel, line 1: no frame comes with a box called red car."}};
  for (const auto& [rule, warning] : rules) {
    Film film(std::string("feel=\"") + rule + "\"");
    film.play_to(40);
    EXPECT_EQ(film.warnings_, std::vector<std::string>{warning});
    EXPECT_EQ(film.velocity_px_s_, Vector2d(0, 0));
  }
  Film film("feel=box");
  film.attach_ = [](GstBuffer* frame, int) {
    gst_buffer_add_video_region_of_interest_meta(frame, "cup", 20, 200, 30, 30);
  };
  film.play_to(40);
  EXPECT_EQ(film.warnings_,
            std::vector<std::string>{
                "feel, line 1: nothing moves in the boxes that come with the frames."});
  EXPECT_EQ(film.velocity_px_s_, Vector2d(0, 0));
}

TEST(Boxes, ThatMakeNoSenseHarmNothing) {
  Film film("feel=box");
  film.attach_ = [](GstBuffer* frame, int n) {
    gst_buffer_add_video_region_of_interest_meta_id(frame, 0, 0, 0, 0, 0);
    gst_buffer_add_video_region_of_interest_meta(frame, "", G_MAXUINT, G_MAXUINT, 1, 1);
    gst_buffer_add_video_region_of_interest_meta(frame, "x", 5, 5, 0, G_MAXUINT);
    gst_buffer_add_video_region_of_interest_meta(frame, "y", 100'000, 5, G_MAXUINT, G_MAXUINT);
    add_region(frame, "face", 1, n);
  };
  EXPECT_GE(fraction_felt(film, 1), Film::kMaxFrames);
}

}  // namespace
}  // namespace spidar::test::boxes_test
