// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/depth_picture.h"
#include "tests/support/allocation_count.h"
#include "tests/support/test.h"

namespace spidar::test::depth_picture_test {
namespace {

constexpr int kColumns = touch::HeightField::kColumns;
constexpr int kRows = touch::HeightField::kRows;
constexpr double kFrame_s = 0.04;

/// Depth of one or two bytes a sample, with rows that are longer than the picture.
class Samples {
 public:
  Samples(int width, int height, int bytes, bool big_endian = false, int padding = 0)
      : stride_(bytes * width + padding),
        view_{nullptr, width, height, stride_, {bytes, 0, big_endian}},
        bytes_(static_cast<size_t>(stride_ * height), uint8_t{255}) {}

  template <typename Depth>
  Samples& fill(Depth&& depth) {
    for (int y = 0; y < view_.height; ++y) {
      for (int x = 0; x < view_.width; ++x) set(x, y, static_cast<int>(depth(x, y)));
    }
    return *this;
  }
  ImageView view() {
    view_.data = bytes_.data();
    return view_;
  }

 private:
  void set(int x, int y, int value) {
    uint8_t* const sample = bytes_.data() + y * stride_ + x * view_.sample.bytes;
    const int low = view_.sample.bytes == 2 && view_.sample.big_endian ? 1 : 0;
    sample[low] = static_cast<uint8_t>(value & 255);
    if (view_.sample.bytes == 2) sample[1 - low] = static_cast<uint8_t>(value >> 8);
  }

  int stride_;
  ImageView view_;
  std::vector<uint8_t> bytes_;
};

float level_at(const touch::DepthPicture& picture, int x, int y) {
  return picture.levels()[y * kColumns + x];
}

// A mean of four samples in single precision: each sum and product rounds by 2^-24.
constexpr double kRounding = 8.0 / (1 << 24);

TEST(DepthPicture, OfADistanceIsHighWhereItIsNear) {
  Samples samples(320, 180, 2);
  samples.fill([](int x, int) { return x < 160 ? 2000 : 1000; });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(samples.view(), {false, 500, 2500}, kFrame_s));
  EXPECT_NEAR(level_at(picture, 10, 70), 0.25, kRounding);
  EXPECT_NEAR(level_at(picture, 250, 70), 0.75, kRounding);
  ASSERT_TRUE(picture.read(samples.view(), {true, 2500, 500}, kFrame_s));
  EXPECT_NEAR(level_at(picture, 10, 70), 0.75, kRounding) << "the same as a disparity";
  ASSERT_TRUE(picture.read(samples.view(), {false, 1200, 1800}, kFrame_s));
  EXPECT_EQ(level_at(picture, 10, 70), 0) << "farther than far";
  EXPECT_EQ(level_at(picture, 250, 70), 1) << "nearer than near";
}

TEST(DepthPicture, OfEverySizeAndOrderIsTheSamePlane) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {16, 16}, {99, 700}, {256, 144}, {641, 481}, {8192, 8192}}) {
    for (const auto& [bytes, big_endian] : {std::pair{1, false}, {2, false}, {2, true}}) {
      Samples samples(width, height, bytes, big_endian, 7);
      const int most = bytes == 1 ? 200 : 50000;
      // From left to right, from 1 to most.
      const double slope = static_cast<double>(most - 1) / std::max(1, width - 1);
      samples.fill([&](int x, int) { return 1 + slope * x; });
      touch::DepthPicture picture;
      ASSERT_TRUE(picture.read(samples.view(), {false, 0, 65535}, kFrame_s));
      for (const int x : {0, 1, 100, 255}) {
        // A cell's centre in samples. The four that are read lie up to half a cell from it, where
        // there are fewer than two a cell they are interpolated; a sample is rounded down.
        const double cell = static_cast<double>(width) / kColumns;
        const double at = std::clamp((x + 0.5) * cell - 0.5, 0.0, width - 1.0);
        const double error = (slope * std::max(0.5, 0.5 * cell) + 1) / 65535 + kRounding;
        const double level = 1 - (1 + slope * at) / 65535;
        EXPECT_NEAR(level_at(picture, x, 70), level, error) << width << "×" << height << " " << x;
        EXPECT_NEAR(level_at(picture, x, 0), level, error);
      }
    }
  }
}

TEST(DepthPicture, MarksHoles) {
  Samples words(256, 144, 2);
  words.fill([](int x, int) { return x < 10 ? 0 : x < 20 ? 65535 : 1000; });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(words.view(), {false, 500, 1500}, kFrame_s));
  EXPECT_TRUE(std::isnan(level_at(picture, 5, 5)));
  EXPECT_TRUE(std::isnan(level_at(picture, 15, 5)));
  EXPECT_NEAR(level_at(picture, 25, 5), 0.5, kRounding);

  Samples bytes(256, 144, 1);
  bytes.fill([](int x, int) { return x < 10 ? 0 : 255; });
  ASSERT_TRUE(picture.read(bytes.view(), {true, 255, 0}, kFrame_s));
  EXPECT_TRUE(std::isnan(level_at(picture, 5, 5)));
  EXPECT_EQ(level_at(picture, 15, 5), 1) << "of a byte the largest value is one";
  ASSERT_TRUE(picture.read(bytes.view(), {true, 255, 0, false}, kFrame_s));
  EXPECT_EQ(level_at(picture, 5, 5), 0);
}

TEST(DepthPicture, AHoleDoesNotChangeWhatIsBesideIt) {
  // In each 2×2 samples of a cell one is missing.
  Samples samples(2 * kColumns, 2 * kRows, 2);
  samples.fill([](int x, int y) { return x % 2 == 0 && y % 2 == 0 ? 0 : 1000; });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(samples.view(), {false, 500, 1500}, kFrame_s));
  for (int i = 0; i < touch::HeightField::kCells; ++i)
    EXPECT_NEAR(picture.levels()[i], 0.5, kRounding);
}

TEST(DepthPicture, WhereThereIsNothingTheLastOneStays) {
  Samples samples(64, 36, 2);
  samples.fill([](int, int) { return 1000; });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(samples.view(), {false, 500, 1500}, kFrame_s));
  samples.fill([](int x, int) { return x % 2 ? 0 : 65535; });
  EXPECT_FALSE(picture.read(samples.view(), {false, 500, 1500}, kFrame_s));
  EXPECT_FALSE(picture.read({}, {}, kFrame_s));
  EXPECT_NEAR(level_at(picture, 5, 5), 0.5, kRounding);
}

TEST(DepthPicture, FindsTheRangeByPercentiles) {
  // A ramp from 1000 to 3000 across, and some samples far away from it.
  Samples samples(512, 288, 2);
  samples.fill([](int x, int y) {
    return y == 7 && x < 100 ? 10 : y == 9 && x < 100 ? 60000 : 1000 + x * 2000 / 511;
  });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(samples.view(), {}, kFrame_s));
  // 2 % of the ramp; the strays are half of two rows in 144, a fifth of a column, 0.14 %; a bin of
  // one sample, a column of cells 2000/256 = 8.
  EXPECT_NEAR(picture.near_sample(), 1040, 0.0014 * 2000 + 8 + 1);
  EXPECT_NEAR(picture.far_sample(), 2960, 0.0014 * 2000 + 8 + 1);
  picture.reset();
  ASSERT_TRUE(picture.read(samples.view(), {true, -1, -1}, kFrame_s));
  EXPECT_NEAR(picture.near_sample(), 2960, 12) << "a disparity is larger where it is near";
  picture.reset();
  ASSERT_TRUE(picture.read(samples.view(), {false, 500, -1}, kFrame_s));
  EXPECT_EQ(picture.near_sample(), 500) << "what is set stays";
  EXPECT_NEAR(picture.far_sample(), 2960, 12);
}

TEST(DepthPicture, TheRangeDoesNotPump) {
  Samples room(256, 144, 2);
  room.fill([](int x, int) { return 2000 + 8 * x; });
  touch::DepthPicture picture;
  for (int n = 0; n < 100; ++n) picture.read(room.view(), {}, kFrame_s);
  const double near = picture.near_sample();
  // Something comes near, over a quarter of the picture, for a fifth of a second.
  Samples visitor(256, 144, 2);
  visitor.fill([](int x, int) { return x < 64 ? 500 : 2000 + 8 * x; });
  double last = near;
  for (int n = 0; n < 5; ++n) {
    picture.read(visitor.view(), {}, kFrame_s);
    // A step is at most 1 − exp(−40 ms / 1 s) of what is left.
    EXPECT_LE(last - picture.near_sample(),
              (near - 500) * kFrame_s / touch::DepthPicture::kRange_s);
    EXPECT_LT(picture.near_sample(), last) << "but it follows";
    last = picture.near_sample();
  }
  for (int n = 0; n < 250; ++n) picture.read(visitor.view(), {}, kFrame_s);
  EXPECT_NEAR(picture.near_sample(), 500, (near - 500) * std::exp(-10.0) + 1) << "after 10 s";
  const double settled = picture.near_sample();
  picture.read(room.view(), {}, 0);
  EXPECT_EQ(picture.near_sample(), settled) << "no time has passed";
}

TEST(DepthPicture, ACutTakesItsRangeAtOnce) {
  Samples near(256, 144, 2);
  near.fill([](int x, int) { return 500 + x; });
  Samples far(256, 144, 2);
  far.fill([](int x, int) { return 5000 + 10 * x; });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(near.view(), {}, kFrame_s));
  ASSERT_TRUE(picture.read(far.view(), {}, kFrame_s));
  EXPECT_GT(picture.near_sample(), 5000);
  ASSERT_TRUE(picture.read(near.view(), {}, kFrame_s));
  EXPECT_LT(picture.far_sample(), 756);
}

TEST(DepthPicture, AWallHasNoReliefOfNoise) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(1600, 2);
  Samples wall(640, 480, 2);
  wall.fill([&](int, int) { return noise(random); });
  touch::DepthPicture picture;
  ASSERT_TRUE(picture.read(wall.view(), {}, kFrame_s));
  // 1/16 of 1600, about the middle. Noise is 2 / √4 in a cell's mean, of which the largest of
  // 36864 is below 5 standard deviations.
  EXPECT_NEAR(picture.far_sample() - picture.near_sample(), 100, 1);
  for (int i = 0; i < touch::HeightField::kCells; ++i) {
    ASSERT_NEAR(picture.levels()[i], 0.5, 5.0 * 1 / 100 + 0.02);
  }
  Samples flat(16, 16, 1);
  flat.fill([](int, int) { return 1; });
  picture.reset();
  ASSERT_TRUE(picture.read(flat.view(), {true, -1, -1}, kFrame_s));
  EXPECT_EQ(picture.near_sample() - picture.far_sample(), touch::DepthPicture::kMinSpan);
  EXPECT_NEAR(level_at(picture, 0, 0), 0.5, kRounding);
}

TEST(DepthPicture, RubbishIsReadWithoutHarm) {
  std::mt19937 random(11);
  touch::DepthPicture picture;
  for (int n = 0; n < 200; ++n) {
    Samples samples(1 + static_cast<int>(random() % 700), 1 + static_cast<int>(random() % 500),
                    1 + static_cast<int>(random() % 2), random() % 2 == 0);
    samples.fill([&](int, int) { return random() & 65535; });
    const bool disparity = random() % 2 == 0;
    touch::DepthSettings settings{disparity, -1, -1};
    if (random() % 3 == 0) settings.near_sample = static_cast<double>(random() % 65536);
    if (random() % 3 == 0) settings.far_sample = static_cast<double>(random() % 65536);
    try {
      validate(settings);
    } catch (const std::invalid_argument&) {
      continue;
    }
    const double dt_s = std::vector<double>{0, -1, 1e9, std::nan(""), 0.04}[random() % 5];
    if (!picture.read(samples.view(), settings, dt_s)) continue;
    ASSERT_TRUE(std::isfinite(picture.near_sample()) && std::isfinite(picture.far_sample()));
    ASSERT_EQ(disparity, picture.near_sample() > picture.far_sample());
    for (int i = 0; i < touch::HeightField::kCells; ++i) {
      const float level = picture.levels()[i];
      ASSERT_TRUE(std::isnan(level) || (level >= 0 && level <= 1));
    }
  }
}

TEST(DepthPicture, TakesNothingFromTheHeapAfterTheFirst) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  Samples samples(640, 480, 2);
  samples.fill([](int x, int y) { return x % 7 ? 500 + x + y : 0; });
  const ImageView view = samples.view();
  touch::DepthPicture picture;
  picture.read(view, {}, kFrame_s);
  const long before = allocations;
  for (int n = 0; n < 3; ++n) picture.read(view, {}, kFrame_s);
  EXPECT_EQ(allocations, before);
}

TEST(DepthPicture, SaysWhatIsWrong) {
  const auto message = [](const touch::DepthSettings& settings) {
    try {
      validate(settings);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({false, 400, 4000}), "");
  EXPECT_EQ(message({true, 255, 0}), "");
  EXPECT_NE(message({false, 4000, 400}).find("near must be less than far (400"), std::string::npos);
  EXPECT_NE(message({false, 400, 400}).find("near must be less than far"), std::string::npos);
  EXPECT_NE(message({true, 0, 255}).find("near must be more than far"), std::string::npos);
  EXPECT_NE(message({false, std::nan(""), 4}).find("near must be at most 65535"),
            std::string::npos);
  EXPECT_NE(message({false, 4, HUGE_VAL}).find("far must be at most 65535"), std::string::npos);
  EXPECT_NE(message({false, 4, 70000}).find("far"), std::string::npos);
}

}  // namespace
}  // namespace spidar::test::depth_picture_test
