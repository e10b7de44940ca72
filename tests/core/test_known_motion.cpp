// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Checks that the films with which trackers are measured move as they claim.
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/known_motion.h"
#include "tests/support/motion_cases.h"
#include "tests/support/photo_sheet.h"

namespace spidar::test::known_motion_test {
namespace {

using Eigen::Affine2d;
using Eigen::Rotation2Dd;
using Eigen::Translation2d;
using Eigen::Vector2d;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

std::vector<uint8_t> pixels(Film& film, int frame) {
  const ImageView view = film.draw(frame);
  std::vector<uint8_t> result;
  for (int y = 0; y < view.height; ++y) {
    const uint8_t* row = view.data + y * view.stride_bytes;
    result.insert(result.end(), row, row + view.width);
  }
  return result;
}

/// Grey levels are rounded: two that stand for the same value differ by at most one.
void expect_same(int a, int b, int x, int y) {
  EXPECT_LE(std::abs(a - b), 1) << x << "," << y;
}

// A cubic spline over the values of a plane is that plane: the place is right to what float gives.
TEST(SplineSheet, IsExactBetweenThePixels) {
  SplineSheet sheet(256, 256);
  sheet.fill([](double x, double y) { return 128 + 0.5 * x - 0.25 * y; });
  constexpr double kRounding = 1e-4;  // 255 · 2⁻²⁴, some 10 operations
  for (const Vector2d& step : {Vector2d(1, 0), Vector2d(0.9, -0.35)}) {
    std::vector<float> grey(51);
    const Vector2d start(-20.37, 10.61);
    sheet.line(start, step, static_cast<int>(grey.size()), grey.data());
    for (size_t k = 0; k < grey.size(); ++k) {
      const Vector2d at = start + static_cast<double>(k) * step;
      EXPECT_NEAR(static_cast<double>(grey[k]), 128 + 0.5 * at.x() - 0.25 * at.y(), kRounding) << k;
    }
  }
}

TEST(SplineSheet, FastLinesAreThoseOfAnyStep) {
  const SplineSheet sheet = photo_sheet(3, 256, 128);
  std::vector<float> fast(200);
  std::vector<float> general(200);
  for (const double x : {-300.0, -0.75, 0.0, 1.2, 2.0, 999.9}) {
    sheet.line({x, 7.3}, {1, 0}, 200, fast.data());
    sheet.line({x, 7.3}, {1 + 1e-12, 0}, 200, general.data());
    for (size_t k = 0; k < fast.size(); ++k)
      EXPECT_NEAR(fast[k], general[k], 1e-3f) << x << " " << k;
  }
}

TEST(PhotoSheet, IsTheSameForTheSameSeedAndHasContrastAndFlatPlaces) {
  const SplineSheet sheet = photo_sheet(1, 512, 512);
  const SplineSheet again = photo_sheet(1, 512, 512);
  const SplineSheet other = photo_sheet(2, 512, 512);
  double sum = 0;
  double squares = 0;
  int flat = 0;
  int different = 0;
  const int n = sheet.columns() * sheet.rows();
  for (int j = 0; j < sheet.rows(); ++j) {
    for (int i = 0; i < sheet.columns(); ++i) {
      const auto grey = static_cast<double>(sheet.control(i, j));
      ASSERT_GE(grey, 0);
      ASSERT_LE(grey, 255);
      ASSERT_EQ(sheet.control(i, j), again.control(i, j));
      different += sheet.control(i, j) != other.control(i, j);
      flat += std::abs(sheet.control(i + 1, j) - sheet.control(i, j)) < 1 &&
              std::abs(sheet.control(i, j + 1) - sheet.control(i, j)) < 1;
      sum += grey;
      squares += grey * grey;
    }
  }
  EXPECT_GT(different, n / 2);
  const double sigma = std::sqrt(squares / n - sum / n * sum / n);
  EXPECT_GT(sigma, 25);
  EXPECT_LT(sigma, 70);
  EXPECT_GT(flat, n / 50);
}

TEST(Film, APanMovesWholePixelsAfterTenFrames) {
  Film film(kWidth, kHeight);
  film.background.sheet = std::make_shared<SplineSheet>(photo_sheet(1, 512, 256));
  film.background.pose = [](double t) { return Affine2d(Translation2d(5.3 * t, -2.1 * t)); };
  const std::vector<uint8_t> first = pixels(film, 0);
  const ImageView last = film.draw(10);
  for (int y = 21; y < kHeight; ++y) {
    for (int x = 0; x + 53 < kWidth; ++x) {
      expect_same(first[static_cast<size_t>(y * kWidth + x)],
                  last.data[(y - 21) * last.stride_bytes + x + 53], x, y);
    }
  }
  const Vector2d moved = film.displacement_px(4, {100, 70});
  EXPECT_NEAR(moved.x(), 5.3, 1e-12);
  EXPECT_NEAR(moved.y(), -2.1, 1e-12);
}

TEST(Film, AQuarterTurnPutsPixelsOnPixels) {
  Film film(101, 101);
  film.background.sheet = std::make_shared<SplineSheet>(photo_sheet(1, 256, 256));
  film.background.pose = [](double t) { return Affine2d(Rotation2Dd(t * std::acos(0.0) / 30)); };
  const std::vector<uint8_t> first = pixels(film, 0);
  const ImageView last = film.draw(30);
  Vector2d path(90, 20);
  for (int n = 1; n <= 30; ++n) path += film.displacement_px(n, path);
  // From x to y: clockwise on the screen.
  EXPECT_LT((path - Vector2d(80, 90)).norm(), 1e-9);
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) {
      expect_same(first[static_cast<size_t>(y * 101 + x)],
                  last.data[x * last.stride_bytes + 100 - y], x, y);
    }
  }
}

/// Where the centre of what differs from the background is.
Vector2d centroid(const ImageView& view, int background) {
  Vector2d sum(0, 0);
  double weight = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const double w = view.data[y * view.stride_bytes + x] - background;
      sum += w * Vector2d(x, y);
      weight += w;
    }
  }
  return sum / weight;
}

// Only the 2 π 30 pixels of the edge err: the part of them that is covered, by up to 6 % where the
// edge is diagonal, σ about 3 %, 30 px from the centre. So the centroid has
// σ = 0.03 √190 · 30/√2 / (π 30²) = 0.003 px, a displacement √2 times that; 3 σ of it.
constexpr double kCentroid_px = 0.013;

TEST(Film, AnObjectIsWhereItsTruthSays) {
  for (const double shutter : {0.0, 0.5}) {
    Film film(kWidth, kHeight);
    film.shutter = shutter;
    film.background = {std::make_shared<SplineSheet>(plain_sheet(50)),
                       [](double) { return Affine2d::Identity(); }};
    film.objects = {{std::make_shared<SplineSheet>(plain_sheet(150)), {30, 30}, [](double t) {
                       return Affine2d(Translation2d(-40 + 6.37 * t, 3.61 * t));
                     }}};
    Vector2d before = centroid(film.draw(0), 50);
    for (int n = 1; n < 8; ++n) {
      const Vector2d centre = film.objects[0].centre_px(n - 1) + film.middle_px();
      EXPECT_LT((before - centre).norm(), kCentroid_px) << n;
      const Vector2d now = centroid(film.draw(n), 50);
      EXPECT_LT((now - before - film.displacement_px(n, centre)).norm(), kCentroid_px) << n;
      EXPECT_EQ(film.displacement_px(n, centre + Vector2d(0, 31)), Vector2d(0, 0));
      before = now;
    }
  }
}

TEST(Film, NoiseAndLightAreWhatIsAskedFor) {
  Film film(kWidth, kHeight);
  film.background = {std::make_shared<SplineSheet>(plain_sheet(100)),
                     [](double) { return Affine2d::Identity(); }};
  film.noise = 5;
  film.light = [](int n) { return n == 0 ? Light() : Light{0.5, 20}; };
  for (int n = 0; n < 2; ++n) {
    double sum = 0;
    double squares = 0;
    for (const uint8_t grey : pixels(film, n)) {
      sum += grey;
      squares += grey * grey;
    }
    const double count = kWidth * kHeight;
    const double mean = sum / count;
    // 5 σ of a mean and of a standard deviation of n values; rounding adds 1/12 to the variance.
    EXPECT_NEAR(mean, n == 0 ? 100 : 70, 5 * 5 / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), std::sqrt(25 + 1 / 12.0),
                5 * 5 / std::sqrt(2 * count));
  }
}

TEST(MotionCases, HaveTheObjectInViewWhereTheyAreMeasured) {
  for (const MotionCase& each : motion_cases()) {
    Film film = each.film(kWidth, kHeight, 1);
    const bool has_object = !film.objects.empty();
    int in_view = 0;
    for (int n = 1; n < kFilmFrames; ++n) {
      for (const FilmObject& object : film.objects) in_view += film.is_in_view(n, object);
    }
    EXPECT_EQ(in_view > 3, has_object) << each.name;
    EXPECT_EQ(has_object && each.group == CaseGroup::kSilent, false) << each.name;
  }
}

TEST(MotionCases, StillIsTheSameFrameAndNamesAreKnown) {
  Film film = motion_case("still").film(kWidth, kHeight, 1);
  EXPECT_EQ(pixels(film, 0), pixels(film, 7));
  try {
    motion_case("waltz");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("waltz"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("translation"), std::string::npos);
  }
}

}  // namespace
}  // namespace spidar::test::known_motion_test
