// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The steps that make a small picture of a frame, compared with their definitions: the vector code
// gives the same bits.
#include "core/picture/padded_image.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar::test::picture_steps_test {
namespace {

using test::Picture;

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

/// Mean of the pixels of each block that are used, rounded.
void reduce_plainly(const ImageView& frame, int factor, PaddedImage& reduced) {
  reduced.resize(frame.width / factor, frame.height / factor);
  for (int y = 0; y < reduced.height(); ++y) {
    for (int x = 0; x < reduced.width(); ++x) {
      int sum = 0;
      int count = 0;
      for (int j = 0; j < factor; j += row_step(factor)) {
        for (int i = 0; i < factor; ++i) {
          sum += *frame.at(x * factor + i, y * factor + j);
          ++count;
        }
      }
      reduced.row(y)[x] = static_cast<uint8_t>((sum + count / 2) / count);
    }
  }
}

TEST(PictureSteps, BlocksAreTheirRoundedMeans) {
  for (const int width : {16, 37, 64, 131, 322}) {
    for (const int height : {16, 31, 50}) {
      const Picture picture = noise(width, height, 1, width % 5);
      for (const int factor : {1, 2, 3, 4, 5, 8, 16}) {
        PaddedImage fast;
        PaddedImage plain;
        reduce_blocks(picture.view(), factor, fast);
        reduce_plainly(picture.view(), factor, plain);
        expect_same(fast, plain, std::to_string(width) + " / " + std::to_string(factor));
        if (fast.width() < 2 || fast.height() < 2) continue;
        PaddedImage half;
        PaddedImage plain_half;
        halve(fast, half);
        reduce_plainly(fast.view(), 2, plain_half);
        expect_same(half, plain_half, "half");
      }
    }
  }
}

TEST(PictureSteps, TheBorderIsRepeatedInAllDirections) {
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

TEST(PictureSteps, FactorsLeaveAFieldOfTheSameArea) {
  struct Case {
    int width, height, factor;
  };
  for (const Case& c : {Case{640, 480, 1}, Case{739, 416, 1}, Case{740, 416, 2}, Case{1280, 720, 2},
                        Case{1920, 1080, 4}, Case{1080, 1920, 4}, Case{3840, 2160, 8},
                        Case{16, 16, 1}, Case{8192, 16, 1}, Case{8192, 64, 2}}) {
    EXPECT_EQ(halving_factor(c.width, c.height), c.factor) << c.width << "x" << c.height;
  }
}

TEST(ImageView, WhatCannotBeLumaIsRefused) {
  const Picture picture(64, 64);
  EXPECT_NO_THROW(require_usable(picture.view()));
  for (const LumaSample& sample : {LumaSample{3, 0, false}, LumaSample{0, 0, false},
                                   LumaSample{2, 9, false}, LumaSample{2, -1, false}}) {
    ImageView view = picture.view();
    view.sample = sample;
    EXPECT_THROW(require_usable(view), std::invalid_argument);
  }
  const uint8_t* const data = picture.pixels.data();
  for (const ImageView& view :
       {ImageView{nullptr, 64, 64, 64},
        {data, 15, 64, 64},
        {data, 64, 0, 64},
        {data, 64, 64, 63},
        {data, 64, 32, 64, {2, 8, false}}}) {  // rows with a byte for each pixel only
    EXPECT_THROW(require_usable(view), std::invalid_argument);
  }
}

}  // namespace
}  // namespace spidar::test::picture_steps_test
