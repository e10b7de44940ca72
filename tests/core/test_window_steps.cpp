// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The steps of following a window, compared with their definitions: the vector code gives the same
// bits.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/tracking/corner.h"
#include "core/tracking/padded_image.h"
#include "core/tracking/window_kernels.h"
#include "core/tracking/window_match.h"
#include "tests/core/plain_window_kernels.h"
#include "tests/support/picture.h"
#include "tests/support/texture.h"

namespace spidar::test::window_steps_test {
namespace {

using test::Picture;
using test::Texture;

/// Grey levels of all sizes, black and white next to each other among them.
Picture noise(int width, int height, uint32_t seed, int padding = 0) {
  Picture picture(width, height, padding);
  std::mt19937 random(seed);
  picture.fill([&](double, double) {
    const auto value = static_cast<uint32_t>(random());
    return value % 4 == 0 ? (value & 16 ? 255.0 : 0.0) : static_cast<double>(value >> 24);
  });
  return picture;
}

void expect_same(const PaddedImage& a, const PaddedImage& b, const std::string& what) {
  ASSERT_EQ(a.width(), b.width()) << what;
  ASSERT_EQ(a.height(), b.height()) << what;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_EQ(a.row(y)[x], b.row(y)[x]) << what << " " << x;
  }
}

TEST(WindowSteps, BlocksAreTheirRoundedMeans) {
  for (const int width : {16, 37, 64, 131, 322}) {
    for (const int height : {16, 31, 50}) {
      const Picture picture = noise(width, height, 1, width % 5);
      for (const int factor : {1, 2, 3, 4, 5, 8, 16}) {
        PaddedImage fast;
        PaddedImage plain;
        reduce_blocks(picture.view(), factor, fast);
        plain::reduce_blocks(picture.view(), factor, plain);
        expect_same(fast, plain, std::to_string(width) + " / " + std::to_string(factor));
        if (fast.width() < 2 || fast.height() < 2) continue;
        PaddedImage half;
        PaddedImage plain_half;
        halve(fast, half);
        plain::reduce_blocks(fast.view(), 2, plain_half);
        expect_same(half, plain_half, "half");
      }
    }
  }
}

TEST(WindowSteps, TheBorderIsRepeatedInAllDirections) {
  PaddedImage image;
  reduce_blocks(noise(40, 30, 3).view(), 1, image);
  image.repeat_border();
  for (int y = -PaddedImage::kPad_px; y < 30 + PaddedImage::kPad_px; ++y) {
    for (int x = -PaddedImage::kPad_px; x < 40 + PaddedImage::kPad_px; ++x) {
      const int inside_x = std::min(std::max(x, 0), 39);
      const int inside_y = std::min(std::max(y, 0), 29);
      ASSERT_EQ(image.row(y)[x], image.row(inside_y)[inside_x]) << x << ", " << y;
    }
  }
}

TEST(WindowSteps, FactorsMakeTheLongerSideAbout480) {
  struct Case {
    int width, height, factor;
  };
  for (const Case& c : {Case{640, 360, 1}, Case{678, 400, 1}, Case{679, 400, 2}, Case{1280, 720, 2},
                        Case{1920, 1080, 4}, Case{1080, 1920, 4}, Case{3840, 2160, 8},
                        Case{16, 16, 1}, Case{8192, 16, 1}, Case{8192, 64, 4}}) {
    EXPECT_EQ(halving_factor(c.width, c.height), c.factor) << c.width << "x" << c.height;
  }
}

/// Eigenvalues of the structure tensor of the window whose upper left pixel is (`left`, `top`),
/// from its definition: the covariance of the derivatives, (grey / px)².
struct DefinedCorner {
  double sum = 0;       ///< of both
  double strength = 0;  ///< the smaller one; 0 where it is below kLeastRoundness of the larger one

  DefinedCorner() = default;
  DefinedCorner(const PaddedImage& image, int left, int top) {
    Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    constexpr double kPixels = kCornerWindow_px * kCornerWindow_px;
    for (int y = top; y < top + kCornerWindow_px; ++y) {
      for (int x = left; x < left + kCornerWindow_px; ++x) {
        const Eigen::Vector2d slope((image.row(y)[x + 1] - image.row(y)[x - 1]) / 2.0,
                                    (image.row(y + 1)[x] - image.row(y - 1)[x]) / 2.0);
        tensor += slope * slope.transpose() / kPixels;
        mean += slope / kPixels;
      }
    }
    const double whole = tensor.trace();
    tensor -= mean * mean.transpose();
    const double half = tensor.trace() / 2;
    const double root = std::sqrt(std::max(0.0, half * half - tensor.determinant()));
    sum = whole;
    strength = half - root > kLeastRoundness * (half + root) ? half - root : 0;
  }
};

TEST(WindowSteps, TheBestCornerIsTheStrongestWindow) {
  std::mt19937 random(7);
  for (int n = 0; n < 60; ++n) {
    PaddedImage image;
    Picture picture = noise(80, 70, static_cast<uint32_t>(n));
    if (n % 2 == 0) {
      const Texture texture(static_cast<uint32_t>(n), 9);
      picture.fill([&](double x, double y) { return texture.at(x, y); });
    }
    reduce_blocks(picture.view(), 1, image);
    image.repeat_border();
    const auto from = [&](int most) {
      return static_cast<int>(random() % static_cast<uint32_t>(most));
    };
    PixelBox box;
    box.x0 = 1 + from(40);
    box.y0 = 1 + from(40);
    box.x1 = std::min(box.x0 + from(70), 79);
    box.y1 = std::min(box.y0 + from(70), 69);
    const Corner corner = best_corner(image, box);
    // Of the float arithmetic, about ten roundings of values up to the sum of both eigenvalues.
    constexpr double kRounding = 10 * 0x1p-24;
    DefinedCorner best, there;
    const int x1 = std::min(box.x1, box.x0 + kMostCornerBox_px) - kCornerWindow_px;
    const int y1 = std::min(box.y1, box.y0 + kMostCornerBox_px) - kCornerWindow_px;
    for (int y = box.y0; y <= y1; y += kCornerStep_px) {
      for (int x = box.x0; x <= x1; x += kCornerStep_px) {
        const DefinedCorner window(image, x, y);
        if (window.strength > best.strength) best = window;
        if (corner.at.x_px == static_cast<float>(x) + 3.5f &&
            corner.at.y_px == static_cast<float>(y) + 3.5f)
          there = window;
      }
    }
    EXPECT_NEAR(corner.strength, best.strength, kRounding * best.sum) << "picture " << n;
    EXPECT_NEAR(corner.strength, there.strength, kRounding * there.sum) << "picture " << n;
  }
}

TEST(WindowSteps, FlatsSlopesAndEdgesHaveNoCorner) {
  const auto strength = [](auto&& grey) {
    Picture picture(64, 64);
    picture.fill(grey);
    PaddedImage image;
    reduce_blocks(picture.view(), 1, image);
    image.repeat_border();
    return best_corner(image, {1, 1, 63, 63}).strength;
  };
  EXPECT_EQ(strength([](double, double) { return 90.0; }), 0);
  EXPECT_EQ(strength([](double x, double y) { return 2 * x + y; }), 0);
  EXPECT_EQ(strength([](double x, double) { return x < 30 ? 20.0 : 220.0; }), 0);
  EXPECT_GT(strength([](double x, double y) { return x < 30 && y < 30 ? 20.0 : 220.0; }), 100);
}

TEST(WindowSteps, AWindowThatIsAlmostAnEdgeHasNoCorner) {
  // A bowl whose derivatives are spread by 2a and 2b grey levels per pixel and pixel, so that the
  // eigenvalues are as a² to b²: 1 to 9, and 1 to 36, which is below kLeastRoundness. Rounding adds
  // 0.04 to both, of 0.5 and more.
  const auto strength = [](double a, double b) {
    Picture picture(32, 32);
    picture.fill(
        [&](double x, double y) { return a * (x - 16) * (x - 16) + b * (y - 16) * (y - 16); });
    PaddedImage image;
    reduce_blocks(picture.view(), 1, image);
    image.repeat_border();
    return best_corner(image, {1, 1, 31, 31}).strength;
  };
  EXPECT_GT(strength(0.15, 0.45), 0);
  EXPECT_EQ(strength(0.15, 0.9), 0);
}

template <int kSide>
void expect_same_kernels(uint32_t seed) {
  const Picture before = noise(64, 64, seed);
  const Picture now = noise(64, 64, seed + 1000);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  const auto source = [&](const Picture& picture) {
    const ptrdiff_t offset = static_cast<ptrdiff_t>(random() % 20) * picture.stride + random() % 20;
    return WindowSource{picture.pixels.data() + offset, picture.stride,
                        BilinearWeights::at(share(random), share(random))};
  };
  const WindowSource from = source(before);
  TemplatePixels<kSide> fast;
  TemplatePixels<kSide> plain;
  EXPECT_EQ(read_template(from, fast), plain::read_template(from, plain)) << seed;
  for (int k = 0; k < kSide * kSide; ++k) {
    ASSERT_EQ(fast.pixel[k], plain.pixel[k]) << seed;
    ASSERT_EQ(fast.dx[k], plain.dx[k]) << seed;
    ASSERT_EQ(fast.dy[k], plain.dy[k]) << seed;
  }
  const WindowSource to = source(now);
  for (const int gain : {kGainOne, kGainOne / 4, 2 * kGainOne - 1, 17'000}) {
    EXPECT_EQ(compare(to, fast, gain), plain::compare(to, plain, gain)) << seed;
  }
}

TEST(WindowSteps, VectorsGiveTheBitsOfThePlainArithmetic) {
  for (uint32_t seed = 1; seed <= 100; ++seed) {
    expect_same_kernels<16>(seed);
    expect_same_kernels<24>(seed);
  }
}

TEST(WindowSteps, WeightsAddUpToOneAndNoneIsNegative) {
  for (int x = 0; x <= 256; ++x) {
    for (int y = 0; y <= 256; ++y) {
      const BilinearWeights w =
          BilinearWeights::at(static_cast<float>(x) / 256, static_cast<float>(y) / 256);
      ASSERT_EQ(w.w00 + w.w01 + w.w10 + w.w11, 256);
      ASSERT_GE(std::min(std::min(w.w00, w.w01), std::min(w.w10, w.w11)), 0) << x << ", " << y;
    }
  }
}

/// Grey of a smooth texture that has moved and whose light has changed.
PaddedImage textured(double dx_px, double dy_px, double gain, double offset) {
  const Texture texture(11, 12);
  Picture picture(96, 96);
  picture.fill([&](double x, double y) {
    return 128 + offset + gain * (texture.at(x - dx_px, y - dy_px) - 128);
  });
  PaddedImage image;
  reduce_blocks(picture.view(), 1, image);
  image.repeat_border();
  return image;
}

TEST(WindowSteps, AWindowIsFoundWhateverTheLight) {
  const PaddedImage before = textured(0, 0, 0.7, 0);
  // Grey levels are rounded in both pictures, σ = 0.29 √2, and the gradient is of 5 levels / px on
  // average over 256 px: 0.005 px. Interpolation between pixels of a texture with structures of
  // 12 px errs by up to h²/8 f'' = 5 · 2π/24 / 8 = 0.16 levels, 0.03 px if all pixels agreed.
  constexpr double kTolerance_px = 0.05;
  for (const double gain : {1.0, 0.7, 1.3}) {
    const PaddedImage now = textured(0.6, -1.3, 0.7 * gain, 12);
    WindowTemplate<16> window;
    ASSERT_TRUE(window.read(ReadablePixels(before), {47.25f, 50.5f}));
    MatchSettings settings;
    settings.iterations = 10;
    settings.step_px = 0.003f;
    WindowMatch match;
    match.centre = {47.25f, 50.5f};
    ASSERT_TRUE(window.find(ReadablePixels(now), settings, match)) << gain;
    EXPECT_NEAR(match.centre.x_px, 47.85, kTolerance_px) << gain;
    EXPECT_NEAR(match.centre.y_px, 49.2, kTolerance_px) << gain;
    EXPECT_LT(match.residual, 0.1f) << gain;
  }
}

TEST(WindowSteps, UnrelatedWindowsHaveALargeResidual) {
  PaddedImage before;
  PaddedImage now;
  reduce_blocks(noise(96, 96, 5).view(), 1, before);
  reduce_blocks(noise(96, 96, 6).view(), 1, now);
  WindowTemplate<16> window;
  ASSERT_TRUE(window.read(ReadablePixels(before), {48, 48}));
  WindowMatch match;
  match.centre = {48, 48};
  MatchSettings settings;
  settings.iterations = 1;
  // √2 for independent ones; its standard error over 256 px is 1/√512 of that, 0.06.
  ASSERT_TRUE(window.find(ReadablePixels(now), settings, match));
  EXPECT_NEAR(match.residual, std::sqrt(2.0), 4 * 0.06);
}

}  // namespace
}  // namespace spidar::test::window_steps_test
