// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/relief.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar::test::relief_test {
namespace {

constexpr int kColumns = touch::HeightField::kColumns;
constexpr int kRows = touch::HeightField::kRows;

touch::HeightField empty_field() {
  return touch::HeightField(0.06, 0.03375);  // square cells of 0.23 mm
}

float lowest(const touch::HeightField& field) {
  return *std::min_element(field.row(0), field.row(0) + touch::HeightField::kCells);
}
float highest(const touch::HeightField& field) {
  return *std::max_element(field.row(0), field.row(0) + touch::HeightField::kCells);
}

/// The steepest position, looked for twice as densely as the samples lie.
double steepest(const touch::HeightField& field) {
  double most = 0;
  for (int y = 0; y < 2 * kRows; ++y) {
    for (int x = 0; x < 2 * kColumns; ++x) {
      const double x_m = (x / 2.0 / kColumns - 0.5) * field.width_m();
      const double y_m = (y / 2.0 / kRows - 0.5) * field.height_m();
      most = std::max(most, field.at(x_m, y_m).slope.norm());
    }
  }
  return most;
}

TEST(Relief, OfBrightnessIsAsHighAsThePictureIsBright) {
  // From 16×16, which is enlarged, to more pixels than cells; portrait too.
  for (const auto& [width, height] :
       {std::pair{16, 16}, {256, 144}, {640, 361}, {99, 700}, {1, 1}, {1920, 1080}}) {
    Picture picture(width, height, 3);
    picture.fill([](double, double) { return 51; });
    touch::HeightField field = empty_field();
    touch::ReliefBuilder builder;
    ASSERT_TRUE(builder.from_brightness(picture.view(), {0.001, 0.01, 5e-4}, field));
    // 51/255 of 10 mm; sums of less than 10⁴ weights, each rounded by 2^-24 of it.
    EXPECT_NEAR(lowest(field), 0.003, 0.003 * 1e4 / (1 << 24)) << width << "×" << height;
    EXPECT_NEAR(highest(field), 0.003, 0.003 * 1e4 / (1 << 24)) << width << "×" << height;
  }
}

TEST(Relief, BlackAndWhiteAreThoseOfTheFilm) {
  // Of a film with limited range; what is blacker or whiter counts as black or white.
  touch::ReliefSettings settings{0.001, 0.01, 5e-4};
  settings.black_grey = 16;
  settings.white_grey = 235;
  for (const auto& [grey, level] :
       {std::pair{16, 0.0}, {235, 1.0}, {16 + 73, 1.0 / 3}, {0, 0.0}, {255, 1.0}}) {
    Picture picture(64, 36);
    picture.fill([level_of = grey](double, double) { return level_of; });
    touch::HeightField field = empty_field();
    touch::ReliefBuilder builder;
    ASSERT_TRUE(builder.from_brightness(picture.view(), settings, field));
    const double height_m = 0.001 + 0.01 * level;
    EXPECT_NEAR(lowest(field), height_m, 0.011 * 1e4 / (1 << 24)) << grey;
    EXPECT_NEAR(highest(field), height_m, 0.011 * 1e4 / (1 << 24)) << grey;
  }
}

TEST(Relief, IsNowhereSteeperThanTheLimit) {
  // An edge in each direction, from black to white. Unlimited, its slope would be 8 mm over the
  // Gaussian of 0.5 mm: 8 / (0.5 √(2π)) = 6.4.
  for (int degrees = 0; degrees < 360; degrees += 15) {
    const double a = degrees * M_PI / 180;
    Picture picture(512, 288);
    picture.fill([&](double x, double y) {
      return std::cos(a) * (x - 256) + std::sin(a) * (y - 144) > 0 ? 255 : 0;
    });
    touch::HeightField field = empty_field();
    touch::ReliefBuilder builder;
    ASSERT_TRUE(builder.from_brightness(picture.view(), {}, field));
    // Where the edge goes from one row of pixels to the next, the slopes across and down are those
    // of positions up to two cells apart, on flanks whose directions differ: 1/1000 at most.
    const double slope = steepest(field);
    EXPECT_LE(slope, 1.001 * touch::ReliefBuilder::kMaxSlope) << degrees;
    EXPECT_GE(slope, 0.9 * touch::ReliefBuilder::kMaxSlope) << "the limit has something to do";
    EXPECT_NEAR(highest(field), 0.008, 1e-6) << "the top stays";
  }
}

TEST(Relief, OfNoiseIsNotSteeperAlongAnAxis) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> level(0, 255);
  Picture picture(256, 144);
  picture.fill([&](double, double) { return level(random); });
  touch::HeightField field = empty_field();
  touch::ReliefBuilder builder;
  ASSERT_TRUE(builder.from_brightness(picture.view(), {0, 0.008, 0}, field));
  for (double x_m = -0.03; x_m < 0.03; x_m += 0.00011) {
    for (double y_m = -0.017; y_m < 0.017; y_m += 0.00013) {
      const touch::SurfacePoint p = field.at(x_m, y_m);
      ASSERT_LE(p.slope.cwiseAbs().maxCoeff(), touch::ReliefBuilder::kMaxSlope);
    }
  }
}

TEST(Relief, FillsAHoleWithTheFartherNeighbour) {
  // Far on the left, near on the right, between them nothing; the top third is missing altogether.
  const float hole = std::nanf("");
  std::vector<float> levels;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      levels.push_back(y < 48 || (x > 100 && x < 150) ? hole : x < 125 ? 0.0F : 1.0F);
    }
  }
  touch::HeightField field = empty_field();
  touch::ReliefBuilder builder;
  ASSERT_TRUE(builder.from_levels(levels.data(), {0, 0.008, 0}, field));
  EXPECT_NEAR(field.row(100)[110], 0, 1e-7);
  EXPECT_NEAR(field.row(100)[150], 0.008, 1e-7);
  EXPECT_NEAR(field.row(0)[50], 0, 1e-7) << "the rows above are as the first one that is there";
  EXPECT_NEAR(field.row(0)[200], 0.008, 1e-7);
}

TEST(Relief, LeavesTheFieldWhereThereIsNothing) {
  touch::HeightField field = empty_field();
  field.row(3)[4] = 0.5F;
  touch::ReliefBuilder builder;
  const std::vector<float> holes(touch::HeightField::kCells, std::nanf(""));
  EXPECT_FALSE(builder.from_levels(holes.data(), {}, field));
  EXPECT_FALSE(builder.from_brightness({}, {}, field));
  EXPECT_EQ(field.row(3)[4], 0.5F);
}

TEST(Relief, FineDetailIsWhatSmoothingTookOut) {
  Picture picture(1024, 576);
  // 10 waves across, 25.6 cells each, and 85 of 3 cells. The Gaussian of 2 cells leaves
  // exp(−2 (π σ / λ)²) of them: 0.886 and 2e-4.
  picture.fill([](double x, double) {
    return 127.5 + 50 * std::sin(2 * M_PI * 10 * x / 1024) +
           50 * std::sin(2 * M_PI * 85 * x / 1024);
  });
  touch::HeightField field = empty_field();
  touch::HeightField fine = empty_field();
  touch::ReliefBuilder builder;
  const touch::ReliefSettings settings{0, 0.008, 2 * field.cell_x_m()};
  ASSERT_TRUE(builder.from_brightness(picture.view(), settings, field));
  builder.fine_detail(settings, fine);
  double coarse = 0;
  double detail = 0;
  for (int x = 0; x < kColumns; ++x) {
    coarse += fine.row(70)[x] * std::sin(2 * M_PI * 10 * (x + 0.5) / kColumns) * 2 / kColumns;
    detail += fine.row(70)[x] * std::sin(2 * M_PI * 85 * (x + 0.5) / kColumns) * 2 / kColumns;
  }
  const double amplitude_m = 0.008 * 50 / 255;
  EXPECT_NEAR(coarse, (1 - 0.886) * amplitude_m, 0.03 * amplitude_m);
  // The mean over a cell of a third of the wave leaves sinc(1/3) = 0.83 of it; the picture is
  // rounded by half a level of 50, the Gaussian ends at three standard deviations (0.3 %).
  EXPECT_NEAR(detail, 0.83 * amplitude_m, 0.03 * amplitude_m);
}

TEST(Relief, SaysWhichSettingIsWrong) {
  const double nan = std::nan("");
  EXPECT_NO_THROW(validate(touch::ReliefSettings()));
  EXPECT_THROW(validate(touch::ReliefSettings{nan, 0.01, 0}), std::invalid_argument);
  EXPECT_THROW(validate(touch::ReliefSettings{0, -0.01, 0}), std::invalid_argument);
  EXPECT_THROW(validate(touch::ReliefSettings{0, 0.01, nan}), std::invalid_argument);
}

}  // namespace
}  // namespace spidar::test::relief_test
