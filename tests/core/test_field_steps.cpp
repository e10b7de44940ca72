// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The steps of the field of block motion, compared with their definitions: the vector code gives
// the same bits, and a block of a moved picture is found where it came from.
#include "core/field/block_field.h"
#include "core/field/block_kernels.h"
#include "core/field/block_search.h"
#include "tests/core/field_film.h"
#include "tests/core/plain_block_kernels.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::field_steps_test {
namespace {

using test::Picture;
using test::Texture;

/// Grey levels of all sizes, black and white next to each other among them.
PaddedImage noise(int width, int height, uint32_t seed) {
  Picture picture(width, height);
  std::mt19937 random(seed);
  picture.fill([&](double, double) {
    const auto value = static_cast<uint32_t>(random());
    return value % 4 == 0 ? (value & 16 ? 255.0 : 0.0) : static_cast<double>(value >> 24);
  });
  return padded(picture);
}

/// 255 where `is(grey)` holds; 0 at the other pixels.
template <typename Is>
PaddedImage only(PaddedImage picture, Is&& is) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) picture.row(y)[x] = is(picture.row(y)[x]) ? 255 : 0;
  }
  return picture;
}

/// A texture that has moved by (`x`, `y`).
PaddedImage moved_texture(double x, double y, double gain = 1, double offset = 0) {
  Picture picture(427, 240);
  const Texture texture(1, 8);
  picture.fill([&](double px, double py) {
    return std::min(255.0, std::max(0.0, gain * texture.at(px - x, py - y) + offset));
  });
  return padded(picture);
}

BlockPixels at(const PaddedImage& image, int x, int y) {
  return {image.row(y) + x, image.stride()};
}

TEST(FieldSteps, KernelsAreTheirDefinitionBitForBit) {
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    const PaddedImage a = noise(64, 48, seed);
    const PaddedImage b = noise(64, 48, seed + 100);
    const PaddedImage all = only(noise(64, 48, seed), [](int) { return true; });
    const PaddedImage mask = only(noise(64, 48, seed + 200), [](int grey) { return grey > 128; });
    for (int k = 0; k < 30; ++k) {
      const int x = k - 5;
      const BlockPixels now = at(a, 20, 16);
      const BlockPixels before = at(b, x, k % 7);
      const BlockPixels counted = at(mask, k % 16, k % 7);
      EXPECT_EQ(compare_blocks(now, before), plain::compare_blocks(now, before, at(all, 0, 0)));
      EXPECT_EQ(compare_blocks(now, before, counted), plain::compare_blocks(now, before, counted));
      EXPECT_EQ(block_difference(now, before, counted),
                plain::block_difference(now, before, counted));
      for (const int limit : {0, 10000, 1 << 30}) {
        EXPECT_EQ(block_difference(now, before, limit),
                  plain::block_difference(now, before, limit));
      }
      EXPECT_EQ(bilinear_difference(now, before, k % 17, (3 * k) % 17),
                plain::bilinear_difference(now, before, k % 17, (3 * k) % 17));
      EXPECT_EQ(difference_from_mean(before), plain::difference_from_mean(before));
      for (const int least : {0, 1, 20000, 2 * 255 * 255}) {
        EXPECT_EQ(steep_pixels(before, least), plain::steep_pixels(before, least));
      }
      EXPECT_EQ(cell_difference(now, before), plain::cell_difference(now, before));
      // Half of the pixels stay, some of them exactly.
      PaddedImage changed = a;
      for (int i = 0; i < 64; ++i) {
        for (int j = 0; j < 48; j += 2) {
          changed.row(j)[i] = static_cast<uint8_t>(std::max(0, a.row(j)[i] - (i + j) % 5));
        }
      }
      const MovedBlock from{before, k % 17, (3 * k) % 17};
      const MovedBlock to{at(a, 25 - x, 12), (5 * k) % 17, k % 3};
      const StayingPixels staying = plain::staying_pixels(now, at(changed, 20, 16), from, to);
      EXPECT_EQ(staying_pixels(now, at(changed, 20, 16), from, to), staying);
      EXPECT_GT(staying.near, staying.exact);
      EXPECT_GT(staying.exact, kBlockArea_px / 4);
    }
  }
}

TEST(FieldSteps, AreaSumsAreThoseOfTheirPixels) {
  AreaSums sums;
  for (const int width : {40, 107}) {  // the second time with memory of another size
    const PaddedImage image = noise(width, 33, 5);
    sums.resize(image.width(), image.height());
    for (int turn = 0; turn < 2; ++turn) sums.read(image);
    for (int y = -kBlockReach_px; y <= 33 + kBlockReach_px - kBlock_px; ++y) {
      for (int x = -kBlockReach_px; x <= width + kBlockReach_px - kBlock_px; ++x) {
        int sum = 0;
        for (int j = 0; j < kBlock_px; ++j) {
          for (int i = 0; i < kBlock_px; ++i) sum += image.row(y + j)[x + i];
        }
        ASSERT_EQ(sums.at(x + kBlockReach_px, y + kBlockReach_px), sum) << x << ", " << y;
      }
    }
  }
  Picture white(16, 16);
  white.fill([](double, double) { return 255.0; });
  sums.resize(white.width, white.height);
  sums.read(padded(white));
  EXPECT_EQ(sums.at(kBlockReach_px, kBlockReach_px), 255 * kBlockArea_px);
}

TEST(FieldSteps, TwoThirdsAreTheMeanOfTheirAreas) {
  for (const int width : {48, 97, 640}) {
    for (const int height : {30, 31, 32}) {
      const PaddedImage image = noise(width, height, 7);
      PaddedImage fast;
      reduce_to_two_thirds(image, fast);
      ASSERT_EQ(fast.width(), width * 2 / 3);
      ASSERT_EQ(fast.height(), height * 2 / 3);
      for (int y = 0; y < fast.height(); ++y) {
        for (int x = 0; x < fast.width(); ++x) {
          // Half of the pixel between two belongs to each; the mean is rounded. It never lies half
          // way between two grey levels: it is a multiple of a ninth.
          double sum = 0;
          for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
              const int px = x / 2 * 3 + (x % 2 == 0 ? i : 1 + i);
              const int py = y / 2 * 3 + (y % 2 == 0 ? j : 1 + j);
              const double wx = px % 3 == 1 ? 0.5 : 1;
              const double wy = py % 3 == 1 ? 0.5 : 1;
              sum += wx * wy * image.row(py)[px];
            }
          }
          ASSERT_NEAR(fast.row(y)[x], sum / 2.25, 0.5) << x << ", " << y;
        }
      }
    }
  }
}

TEST(FieldSteps, ThePictureHasAboutTheSameAreaWhateverTheFrame) {
  EXPECT_EQ(field_scale(427, 240), FieldScale::kSame);
  EXPECT_EQ(field_scale(640, 360), FieldScale::kTwoThirds);
  EXPECT_EQ(field_scale(480, 270), FieldScale::kSame);
  EXPECT_EQ(field_scale(270, 480), FieldScale::kSame);
  EXPECT_EQ(field_scale(900, 900), FieldScale::kHalf);
  EXPECT_EQ(field_scale(600, 20), FieldScale::kSame) << "no side becomes less than 16 px";
}

/// Of a block's displacement by the Gauss–Newton step from the nearest whole pixel, which is
/// `step_px` away. The step is short by R / (λ + R) for the regularisation R and the weakest
/// texture λ. The derivatives are off by (3 sin ω − sin 2ω / 2) / 2ω − 1: at most 4 % up to 2π / 5
/// px, where the texture's cubic B-splines over 8 px have ended. And each grey level is rounded
/// `rounded` times, σ² = 1/12 each, over 256 pixels: five deviations.
double block_tolerance_px(double step_px, double weakest_texture, double rounded) {
  const double regularization = MotionBlock::kRegularization;
  const double bias = regularization / (weakest_texture + regularization) + 0.04;
  return bias * step_px + 5 * std::sqrt(rounded / 12 / (256 * weakest_texture));
}

/// In both pictures.
constexpr double kRounded = 2;

/// How far from the true position the search in whole pixels ends: at the nearest pixel of a strong
/// texture that is about the same in all directions, else perhaps at the next one along an edge.
double step_px(const MotionBlock& block, double nearest_px) {
  const float weakest = block.weakest_texture();
  const bool is_round = weakest > 8 * MotionBlock::kRegularization &&
                        2 * weakest >= block.structure.trace() - weakest;
  return is_round || nearest_px == 0 ? nearest_px : static_cast<double>(kMaxOff_px);
}

/// The displacement of a block's middle, away from the rim, where the picture goes on as it began.
void expect_field(const BlockField& field, double x_px, double y_px, double rounded = kRounded) {
  const BlockGrid& grid = field.grid();
  const double nearest_px = std::hypot(x_px - std::round(x_px), y_px - std::round(y_px));
  for (size_t i = 0; i < grid.size(); ++i) {
    const MotionBlock& block = field.blocks()[i];
    const auto texture = static_cast<double>(block.weakest_texture());
    if (grid.columns_beside(i) < 4 || grid.rows_beside(i) < 4 || texture < 6) continue;
    ASSERT_LT((block.moved_px.cast<double>() - Eigen::Vector2d(x_px, y_px)).norm(),
              block_tolerance_px(step_px(block, nearest_px), texture, rounded))
        << grid.column(i) << ", " << grid.row(i) << ", texture " << texture;
  }
}

TEST(FieldSteps, BlocksMoveAsThePictureDoes) {
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {3.0, -2.0}, {5.5, 1.25}, {-12.3, 7.7}}) {
    BlockField field;
    EXPECT_EQ(field.update(moved_texture(0, 0)), BlockField::Result::kFirst);
    EXPECT_EQ(field.update(moved_texture(x, y)), BlockField::Result::kMoved);
    expect_field(field, x, y);
    // Again the same way: what a block did before is where its search begins.
    EXPECT_EQ(field.update(moved_texture(2 * x, 2 * y)), BlockField::Result::kMoved);
    expect_field(field, x, y);
  }
}

TEST(FieldSteps, LightThatChangesInAPanIsNoMotion) {
  for (const double pan_px : {5.0, 6.0, 7.0, 8.0}) {
    BlockField field;
    field.update(moved_texture(0, 0));
    field.update(moved_texture(pan_px, 0));
    EXPECT_EQ(field.update(moved_texture(2 * pan_px, 0, 0.9)), BlockField::Result::kMoved);
    int right = 0;
    for (const MotionBlock& block : field.blocks()) {
      right += (block.moved_px.cast<double>() - Eigen::Vector2d(pan_px, 0)).norm() < 0.5;
    }
    // The blocks of the column that comes into view were not in the picture before.
    EXPECT_GE(right, (field.grid().columns - 2) * field.grid().rows) << pan_px;
  }
}

TEST(FieldSteps, OnlyAnotherPictureIsACutInNoiseToo) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise_grey(0, 6);
  const Texture texture(1, 8);
  const auto noisy = [&](double x, double y) {
    Picture picture(427, 240);
    picture.fill([&](double px, double py) {
      const double grey = 128 + 0.3 * (texture.at(px - x, py - y) - 128) + noise_grey(random);
      return std::min(255.0, std::max(0.0, grey));
    });
    return padded(picture);
  };
  BlockField field;
  field.update(noisy(0, 0));
  for (int n = 1; n <= 3; ++n) {
    EXPECT_EQ(field.update(noisy(3 * n, n)), BlockField::Result::kMoved) << n;
  }
  EXPECT_EQ(field.update(noise(427, 240, 1)), BlockField::Result::kCut);
}

TEST(FieldSteps, DifferenceIsLeastWhereTheBlockCameFrom) {
  BlockField field;
  field.update(moved_texture(0, 0));
  field.update(moved_texture(2.5, 1));
  const size_t middle = field.grid().size() / 2;
  const int there = field.difference_if_moved(middle, {2.5f, 1});
  EXPECT_LT(there, field.difference_if_moved(middle, {0, 0}));
  EXPECT_LT(there, field.difference_if_moved(middle, {5, 3}));
  EXPECT_LT(field.difference_if_moved(middle, {1000, 0}), 0) << "out of reach";
  EXPECT_LT(field.difference_if_moved(middle, {std::nanf(""), 0}), 0);
}

}  // namespace
}  // namespace spidar::test::field_steps_test
