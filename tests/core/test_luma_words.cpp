// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames of more than 8 bits: the vector code gives the bits of the plain one, and both those of
// the same picture in bytes.
#include "core/picture/luma.h"
#include "core/picture/padded_image.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
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

}  // namespace
}  // namespace spidar::test::luma_words_test
