// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/height_field.h"
#include "tests/support/test.h"

namespace spidar::test::height_field_test {
namespace {

constexpr double kWidth_m = 0.06;
constexpr double kHeight_m = 0.034;

using Surface = std::function<double(double x_m, double y_m)>;

touch::HeightField field_of(const Surface& surface) {
  touch::HeightField field(kWidth_m, kHeight_m);
  for (int y = 0; y < touch::HeightField::kRows; ++y) {
    for (int x = 0; x < touch::HeightField::kColumns; ++x) {
      field.row(y)[x] = static_cast<float>(surface(field.x_m(x), field.y_m(y)));
    }
  }
  return field;
}

/// Samples are floats: heights of at most 1 cm are rounded by 2^-24 of it, and a slope is a
/// difference of two of them over a cell.
constexpr double kRounding_m = 0.01 / (1 << 24);
const double kSlopeRounding = 4 * kRounding_m / (kHeight_m / touch::HeightField::kRows);

TEST(HeightField, ReproducesAPlane) {
  const touch::HeightField field =
      field_of([](double x_m, double y_m) { return 0.001 + 0.1 * x_m - 0.2 * y_m; });
  std::mt19937 random(1);
  // Three cells from the border the border's heights do not matter.
  std::uniform_real_distribution<double> across(-0.48 * kWidth_m, 0.48 * kWidth_m);
  std::uniform_real_distribution<double> along(-0.47 * kHeight_m, 0.47 * kHeight_m);
  for (int n = 0; n < 1000; ++n) {
    const double x_m = across(random);
    const double y_m = along(random);
    const touch::SurfacePoint p = field.at(x_m, y_m);
    EXPECT_NEAR(p.z_m, 0.001 + 0.1 * x_m - 0.2 * y_m, kRounding_m);
    EXPECT_NEAR(p.slope.x(), 0.1, kSlopeRounding);
    EXPECT_NEAR(p.slope.y(), -0.2, kSlopeRounding);
  }
}

/// A slope is a difference of floats, so that a shade is rounded up or down.
TEST(HeightField, ShadingTellsWhereASlopeFaces) {
  const double facing = 1 / std::sqrt(2.0);  // 45° towards the upper left, where the light is
  const auto shade = [](double slope_x, double slope_y) {
    const std::string shading =
        field_of([&](double x_m, double y_m) { return slope_x * x_m + slope_y * y_m; }).shading();
    EXPECT_EQ(shading.size(), static_cast<size_t>(touch::HeightField::kCells));
    return static_cast<int>(static_cast<uint8_t>(
        shading[touch::HeightField::kCells / 2 + touch::HeightField::kColumns / 2]));
  };
  EXPECT_EQ(shade(0, 0), 128);
  EXPECT_NEAR(shade(facing, -facing), 255, 1);
  EXPECT_NEAR(shade(-facing, facing), 0, 1);
  EXPECT_EQ(shade(-2 * facing, 2 * facing), 0) << "no darker than in the shadow";
  EXPECT_GT(shade(0.3, 0), 128) << "it rises to the right, and so faces left";
  EXPECT_GT(shade(0, -0.3), 128) << "it rises downwards, and so faces up";
}

TEST(HeightField, SlopeIsTheDerivativeOfTheHeight) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> height_m(0, 0.008);
  const touch::HeightField field = field_of([&](double, double) { return height_m(random); });
  std::uniform_real_distribution<double> across(-0.6 * kWidth_m, 0.6 * kWidth_m);
  std::uniform_real_distribution<double> along(-0.6 * kHeight_m, 0.6 * kHeight_m);
  // Central differences over 2 d are wrong by d²/6 of the third derivative, which is at most the
  // third difference of the samples over cell³: 8 · 8 mm / (0.23 mm)³ = 5.3e9 / m².
  constexpr double kStep_m = 1e-7;
  constexpr double kError = kStep_m * kStep_m / 6 * 5.3e9 + 1e-15 / kStep_m;
  for (int n = 0; n < 2000; ++n) {
    const double x_m = across(random);
    const double y_m = along(random);
    const touch::SurfacePoint p = field.at(x_m, y_m);
    EXPECT_NEAR(p.slope.x(),
                (field.at(x_m + kStep_m, y_m).z_m - field.at(x_m - kStep_m, y_m).z_m) / 2 / kStep_m,
                kError);
    EXPECT_NEAR(p.slope.y(),
                (field.at(x_m, y_m + kStep_m).z_m - field.at(x_m, y_m - kStep_m).z_m) / 2 / kStep_m,
                kError);
    EXPECT_GE(p.z_m, 0);
    EXPECT_LE(p.z_m, 0.008 + kRounding_m);
  }
}

TEST(HeightField, GoesOnLevelOutsideThePicture) {
  const touch::HeightField field =
      field_of([](double x_m, double y_m) { return 0.1 * x_m + 0.1 * y_m; });
  const double inf = std::numeric_limits<double>::infinity();
  for (const double x_m : {-inf, -1e9, -0.04, 0.04, 1e9, inf}) {
    EXPECT_EQ(field.at(x_m, 0).slope.x(), 0) << x_m;
    EXPECT_NEAR(field.at(x_m, 0).z_m, std::copysign(0.1 * field.x_m(255), x_m), kRounding_m);
    EXPECT_EQ(field.at(0, x_m).slope.y(), 0) << x_m;
    EXPECT_NEAR(field.at(0, x_m).z_m, std::copysign(0.1 * field.y_m(0), x_m), kRounding_m);
  }
  EXPECT_TRUE(std::isfinite(field.at(std::nan(""), std::nan("")).z_m));
}

TEST(HeightField, SaysWhichExtentIsWrong) {
  EXPECT_THROW(touch::HeightField(0, 1), std::invalid_argument);
  EXPECT_THROW(touch::HeightField(1, std::nan("")), std::invalid_argument);
  try {
    touch::HeightField(-1, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("width_m"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace spidar::test::height_field_test
