// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Whether the camera moves, in films of which an encoder has left little but an object.
// spidar-bench camera has more of them.
#include "tests/support/coded_film_score.h"
#include "tests/support/test.h"

namespace spidar::test::coded_films_test {
namespace {

/// Fraction of the pictures; coding differs from release to release.
constexpr double kMax = 0.9;

class CodedFilms : public testing::TestWithParam<const Coding*> {
 protected:
  void SetUp() override {
    film_.coding = GetParam()->options;
    film_.speed_px = 8;
  }
  CodedFilm film_;
};

TEST_P(CodedFilms, AWallBehindALargeSquareRests) {
  film_.side_px = 200;
  film_.radius_px = 40;
  const std::vector<Picture> pictures = film_.pictures();
  if (pictures.empty()) GTEST_SKIP() << "no ffmpeg that codes " << film_.coding;
  const CodedFilmScore right = score(film_, pictures);
  EXPECT_EQ(right.camera, right.pictures);
  EXPECT_GT(right.felt, kMax * right.pictures);
}

TEST_P(CodedFilms, ThePanOverAFaintWallIsFound) {
  film_.wall = CodedFilm::Wall::kFaint;
  film_.pan_px << 3, 0;
  film_.side_px = 64;
  film_.radius_px = 50;
  film_.speed_px = 5;
  const std::vector<Picture> pictures = film_.pictures();
  if (pictures.empty()) GTEST_SKIP() << "no ffmpeg that codes " << film_.coding;
  const CodedFilmScore right = score(film_, pictures);
  EXPECT_GT(right.camera, kMax * right.pictures);
  EXPECT_GT(right.felt, kMax * right.pictures);
}

// Two thirds of the picture show nothing, so that most plain parts do not say that they move; the
// border does.
TEST_P(CodedFilms, ThePanOverAMeadowBelowAPlainSkyIsFound) {
  film_.wall = CodedFilm::Wall::kMeadow;
  film_.noise_grey = 2;  // of more, HEVC leaves hardly any meadow at this quality
  film_.pan_px << 3, 0;
  const std::vector<Picture> pictures = film_.pictures();
  if (pictures.empty()) GTEST_SKIP() << "no ffmpeg that codes " << film_.coding;
  const CodedFilmScore right = score(film_, pictures);
  EXPECT_GT(right.camera, kMax * right.pictures);
}

// An area is larger than the square, and a third of those of such a small picture contain some of
// it: they follow the wall, without the blocks that show by themselves that they rest.
TEST_P(CodedFilms, ThePanOfASmallPictureBehindASquareThatItFollowsIsFound) {
  film_.width_px = 192;
  film_.height_px = 144;
  film_.wall = CodedFilm::Wall::kFaint;
  film_.noise_grey = 2;
  film_.pan_px << -3, 0;
  film_.side_px = 48;
  film_.speed_px = 0;
  const std::vector<Picture> pictures = film_.pictures();
  if (pictures.empty()) GTEST_SKIP() << "no ffmpeg that codes " << film_.coding;
  // AV1 leaves so little of it that some pictures show nothing.
  const CodedFilmScore right = score(film_, pictures);
  EXPECT_GT(right.camera, right.pictures / 2);
}

INSTANTIATE_TEST_SUITE_P(By, CodedFilms, testing::Values(&kX264, &kX265, &kSvtAv1),
                         [](const auto& instance) {
                           std::string name = instance.param->name;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

}  // namespace
}  // namespace spidar::test::coded_films_test
