// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films of 10, 12 and 16 bits are felt as the same film in 8 bits, bit for bit.
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/texture.h"
#include "tests/support/word_picture.h"

namespace spidar::test::luma_formats_test {
namespace {

using test::kWordSamples;
using test::Picture;
using test::WordPicture;

constexpr int64_t kFrame_ns = 40'000'000;

/// A film of a camera that pans, `width` px wide.
Picture frame_of(int width, int n) {
  static const test::Texture texture(1, 9);
  Picture picture(width, width * 9 / 16);
  picture.fill([&](double x, double y) { return texture.at(x - 3.3 * n, y + 1.7 * n); });
  return picture;
}

class LumaFormats : public testing::TestWithParam<MotionKind> {};

TEST_P(LumaFormats, AreFeltAsTheFilmInBytes) {
  AnalyzerSettings settings;
  settings.motion = GetParam();
  for (const int width : {320, 720, 1500}) {  // factors 1, 2 and 4
    for (const LumaSample& sample : kWordSamples) {
      SCOPED_TRACE(test::name_of(sample) + ", " + std::to_string(width));
      MotionAnalyzer bytes(settings), words(settings);
      int tracked = 0;
      for (int n = 0; n < 4; ++n) {
        const Picture picture = frame_of(width, n);
        const WordPicture word_picture(picture, sample);
        const Frame a = bytes.analyze(picture.view(), n * kFrame_ns);
        const Frame b = words.analyze(word_picture.view(), n * kFrame_ns);
        EXPECT_EQ(a.features, b.features);
        EXPECT_EQ(a.motion.tracked, b.motion.tracked);
        EXPECT_EQ(a.motion.velocity_px_s, b.motion.velocity_px_s);
        EXPECT_EQ(a.wrench.stacked(), b.wrench.stacked());
        tracked += a.motion.tracked;
      }
      EXPECT_GT(tracked, 60);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FieldAndPoints, LumaFormats,
                         testing::Values(MotionKind::kCamera, MotionKind::kMean));

TEST(LumaSample, WhatCannotBeLumaIsRefused) {
  const Picture picture = frame_of(320, 0);
  MotionAnalyzer analyzer;
  for (const LumaSample& sample : {LumaSample{3, 0, false}, LumaSample{0, 0, false},
                                   LumaSample{2, 9, false}, LumaSample{2, -1, false}}) {
    ImageView view = picture.view();
    view.sample = sample;
    EXPECT_THROW(analyzer.analyze(view, 0), std::invalid_argument);
  }
  ImageView half = picture.view();
  half.sample = {2, 8, false};  // its rows have a byte for each pixel only
  EXPECT_THROW(analyzer.analyze(half, 0), std::invalid_argument);
}

}  // namespace
}  // namespace spidar::test::luma_formats_test
