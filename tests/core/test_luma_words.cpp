// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames of more than 8 bits: the vector code gives the bits of the plain one, and both those of
// the same picture in bytes.
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/tracking/luma_neighbourhood.h"
#include "core/tracking/luma_row.h"
#include "core/tracking/padded_image.h"
#include "tests/support/picture.h"
#include "tests/support/word_picture.h"

namespace spidar::test::luma_words_test {
namespace {

using test::kWordSamples;
using test::Picture;
using test::WordPicture;

Picture noise(int width, int height, uint32_t seed) {
  Picture picture(width, height, width % 5);
  std::mt19937 random(seed);
  picture.fill([&](double, double) { return static_cast<double>(random() % 256); });
  return picture;
}

TEST(LumaWords, ARowIsTheHighestEightBits) {
  const Picture picture = noise(100, 3, 1);
  for (const LumaSample& sample : kWordSamples) {
    SCOPED_TRACE(test::name_of(sample));
    const WordPicture words(picture, sample);
    for (const int columns : {1, 15, 16, 17, 32, 63, 97}) {
      std::vector<uint8_t> expected(static_cast<size_t>(columns));
      std::vector<uint8_t> read(expected);
      copy_row(picture.view(), 3, 2, columns, expected.data());
      copy_row(words.view(), 3, 2, columns, read.data());
      EXPECT_EQ(read, expected) << columns;
    }
  }
}

TEST(LumaWords, BitsAboveTheDepthAreWhite) {
  // 10 bits in a word that says 0xFFFF, and 1024, the least that is too much.
  const std::vector<uint8_t> bytes{0xFF, 0xFF, 0x00, 0x04, 0xFF, 0x03, 0x00, 0x02};
  const std::vector<uint8_t> expected{255, 255, 255, 128};
  std::vector<uint8_t> many;
  for (int i = 0; i < 4; ++i) many.insert(many.end(), bytes.begin(), bytes.end());
  const ImageView frame{many.data(), 16, 1, 32, {2, 2, false}};
  for (const size_t columns : {16u, 4u}) {  // by vectors, and one by one
    std::vector<uint8_t> read(columns);
    copy_row(frame, 0, 0, static_cast<int>(columns), read.data());
    for (size_t i = 0; i < columns; ++i) EXPECT_EQ(read[i], expected[i % 4]) << i;
  }
}

TEST(LumaWords, BlocksAreThoseOfBytes) {
  for (const int width : {16, 37, 131, 322}) {
    const Picture picture = noise(width, 50, 2);
    for (const LumaSample& sample : kWordSamples) {
      const WordPicture words(picture, sample);
      for (const int factor : {1, 2, 3, 4, 8, 16}) {
        SCOPED_TRACE(test::name_of(sample) + ", " + std::to_string(width) + " / " +
                     std::to_string(factor));
        PaddedImage bytes, reduced;
        reduce_blocks(picture.view(), factor, bytes);
        reduce_blocks(words.view(), factor, reduced);
        ASSERT_EQ(reduced.width(), bytes.width());
        ASSERT_EQ(reduced.height(), bytes.height());
        for (int y = 0; y < bytes.height(); ++y) {
          for (int x = 0; x < bytes.width(); ++x) {
            ASSERT_EQ(reduced.row(y)[x], bytes.row(y)[x]) << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST(LumaWords, AWindowIsReadAndFoundWhereBytesAre) {
  constexpr int kWidth = 90, kHeight = 70;
  constexpr int kWindow = LumaNeighbourhood::kWindow_px;
  const auto film = [](double dx, double dy) {
    Picture picture(kWidth, kHeight);
    picture.fill([&](double x, double y) {
      return 128 + 60 * std::sin(0.31 * (x - dx)) +
             60 * std::cos(0.27 * (y - dy) + 0.05 * (x - dx));
    });
    return picture;
  };
  const Picture before = film(0, 0), now = film(2.4, -1.7);
  LumaNeighbourhood bytes, words;
  std::mt19937 random(3);
  int found = 0;
  for (const LumaSample& sample : kWordSamples) {
    const WordPicture words_before(before, sample), words_now(now, sample);
    for (int n = 0; n < 200; ++n) {
      // Also beside the frame, where neither must read anything.
      const ImagePoint at{static_cast<float>(random() % 1200) / 10 - 15,
                          static_cast<float>(random() % 1000) / 10 - 15};
      SCOPED_TRACE(test::name_of(sample) + " at " + std::to_string(at.x_px) + ", " +
                   std::to_string(at.y_px));
      WindowTemplate<kWindow> a, b;
      const bool has = a.read(bytes.around(before.view(), at, 0), at);
      ASSERT_EQ(b.read(words.around(words_before.view(), at, 0), at), has);
      if (!has) continue;
      EXPECT_EQ(a.strength(), b.strength());
      MatchSettings settings;
      settings.reach_px = LumaNeighbourhood::kMostReach_px;
      WindowMatch match_a, match_b;
      match_a.centre = match_b.centre = at;
      const bool is_there =
          a.find(bytes.around(now.view(), at, settings.reach_px), settings, match_a);
      ASSERT_EQ(b.find(words.around(words_now.view(), at, settings.reach_px), settings, match_b),
                is_there);
      if (!is_there) continue;
      ++found;
      EXPECT_EQ(match_a.centre.x_px, match_b.centre.x_px);
      EXPECT_EQ(match_a.centre.y_px, match_b.centre.y_px);
      EXPECT_EQ(match_a.residual, match_b.residual);
    }
  }
  EXPECT_GT(found, 200);
}

}  // namespace
}  // namespace spidar::test::luma_words_test
