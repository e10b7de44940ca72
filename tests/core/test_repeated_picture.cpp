// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which frames repeat the previous picture: with the same pixels, or changed by coding.
#include <numeric>

#include "core/picture/repeated_picture.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::repeated_picture_test {
namespace {

using test::Picture;
using Kind = FrameComparison;

/// Noise of `grey` levels up and down, each as likely.
Picture moved(double dx, uint32_t noise_seed = 0, uint32_t grey = 2) {
  static const test::Texture texture(1, 9);
  std::mt19937 random(noise_seed);
  Picture picture(150, 90);
  picture.fill([&](double x, double y) {
    const double noise =
        noise_seed > 0 ? static_cast<double>(random() % (2 * grey + 1)) - static_cast<double>(grey)
                       : 0;
    return texture.at(x - dx, y) / 2 + 60 + noise;
  });
  return picture;
}

/// largest_change() pixel by pixel. The means are added from the largest on, as there, so that
/// rounding is the same.
float defined_change(const ImageView& a, const ImageView& b) {
  std::vector<float> means;
  for (int top = 0; top < a.height; top += 16) {
    for (int left = 0; left < a.width; left += 16) {
      const int bottom = std::min(top + 16, a.height), right = std::min(left + 16, a.width);
      int sum = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) sum += std::abs(*a.at(x, y) - *b.at(x, y));
      }
      means.push_back(static_cast<float>(sum) /
                      static_cast<float>((bottom - top) * (right - left)));
    }
  }
  std::sort(means.begin(), means.end(), std::greater<>());
  means.resize(std::min(means.size(), kChangedBlocks));
  return std::accumulate(means.begin(), means.end(), 0.0f) / static_cast<float>(means.size());
}

TEST(RepeatedPicture, TheLargestChangeIsThatOfItsDefinition) {
  std::mt19937 random(1);
  for (const int width : {16, 17, 31, 64, 101}) {
    for (const int height : {16, 23, 48}) {
      Picture a(width, height, 3), b(width, height, 5);
      a.fill([&](double, double) { return static_cast<double>(random() % 256); });
      b.fill([&](double, double) { return static_cast<double>(random() % 256); });
      EXPECT_EQ(largest_change(a.view(), b.view()), defined_change(a.view(), b.view()));
      EXPECT_EQ(largest_change(a.view(), a.view()), 0);
      Picture c = a;
      c.at(width - 1, height - 1) ^= 1;  // the last pixel counts
      EXPECT_GT(largest_change(a.view(), c.view()), 0);
      EXPECT_EQ(largest_change(a.view(), c.view()), defined_change(a.view(), c.view()));
    }
  }
}

TEST(RepeatedPicture, HardlyAnyNoiseIsTheSamePictureAtOnce) {
  RepeatedPicture repeated;
  Picture before = moved(0);
  float large = 0;
  for (uint32_t n = 1; n < 12; ++n) {
    const bool again = n % 3 == 0;
    Picture now = again ? before : moved(4.0 * n);
    for (int y = 0; again && y < 90; ++y) {
      for (int x = 0; x < 150; x += 8) now.at(x, y) ^= 1;
    }
    const float change = largest_change(before.view(), now.view());
    if (again) {
      ASSERT_LT(change, RepeatedPicture::kFractionAtOnce * large) << n;
    } else {
      large = change;
    }
    EXPECT_EQ(repeated.compare(before.view(), now.view()), again ? Kind::kAlike : Kind::kOther)
        << n;
    before = now;
  }
}

// At its turn it moves by less than a tenth of what it did before. Two of these are no rhythm yet.
TEST(RepeatedPicture, ASwingThatTurnsBetweenTwoPicturesIsNoRepeat) {
  constexpr double kSwing_px = 60, kPeriod_frames = 10, kPhase_frames = 0.05;
  RepeatedPicture repeated;
  Picture before = moved(kSwing_px * std::sin(6.2832 * kPhase_frames / kPeriod_frames));
  float least = 1, large = 0;
  for (uint32_t n = 1; n < 13; ++n) {
    const Picture now = moved(kSwing_px * std::sin(6.2832 * (n + kPhase_frames) / kPeriod_frames));
    const float change = largest_change(before.view(), now.view());
    if (n > 1) least = std::min(least, change / large);
    large = change;
    EXPECT_EQ(repeated.compare(before.view(), now.view()), Kind::kOther) << n;
    before = now;
  }
  EXPECT_LT(least, 0.1F);
}

/// A film on twos, or one that moves by `step_px` from frame to frame, after a cut from one on
/// twos.
std::vector<Kind> after_a_cut(double step_px, bool on_twos, uint32_t grey) {
  RepeatedPicture repeated;
  Picture before = moved(0, 1, grey);
  const auto look = [&](const Picture& now) {
    const Kind kind = repeated.compare(before.view(), now.view());
    if (kind == Kind::kOther) before = now;
    return kind;
  };
  uint32_t n = 1;
  for (; n < 20; ++n) look(moved(4.0 * (n / 2), n + 1, grey));
  constexpr double kElsewhere_px = 300;
  EXPECT_EQ(look(moved(kElsewhere_px, ++n, grey)), Kind::kOther);
  repeated.cut();
  std::vector<Kind> kinds;
  for (uint32_t k = 1; k < 10; ++k) {
    const double moved_px = step_px * (on_twos ? k / 2 : k);
    kinds.push_back(look(moved(kElsewhere_px + moved_px, ++n, grey)));
  }
  return kinds;
}

// Beside the change of the cut, all motion after it would be small.
TEST(RepeatedPicture, ARhythmIsKnownAfterACutButItsChangeIsNoMotion) {
  constexpr uint32_t kGrey = 3;  // more than hardly any
  std::vector<Kind> kinds = after_a_cut(4, true, kGrey);
  for (size_t k = 2; k < kinds.size(); ++k) {
    EXPECT_EQ(kinds[k], k % 2 == 0 ? Kind::kAlike : Kind::kOther) << k;
  }
  kinds = after_a_cut(0.5, false, 1);
  for (const Kind kind : kinds) EXPECT_EQ(kind, Kind::kOther);
}

TEST(RepeatedPicture, AMotionThatReversesIsNoRepeat) {
  RepeatedPicture repeated;
  Picture before = moved(0, 1);
  double position = 0;
  for (uint32_t n = 1; n < 100; ++n) {
    const double speed = 4 - std::abs(static_cast<double>(n % 16) - 8);  // −4 … 4 px a frame
    position += speed;
    const Picture now = moved(position, n + 1);
    EXPECT_EQ(repeated.compare(before.view(), now.view()), Kind::kOther) << n;
    before = now;
  }
}

/// Four pictures in five frames, as the first fields of a telecined film show them.
double telecined_px(uint32_t frame) {
  return 4.0 * (frame - (frame + 2) / 5);
}

TEST(RepeatedPicture, NoiseMayBeLargerWhereARepeatIsDue) {
  constexpr uint32_t kGrey = 5;
  RepeatedPicture repeated;
  Picture before = moved(0, 1, kGrey);
  float large = 0;
  for (uint32_t n = 1; n < 60; ++n) {
    const bool again = n % 5 == 3;
    ASSERT_EQ(again, telecined_px(n) == telecined_px(n - 1)) << n;
    const Picture now = moved(telecined_px(n), n + 1, kGrey);
    const float change = largest_change(before.view(), now.view());
    if (again) {
      // As of an encoder that spends its bits on the repeated field.
      ASSERT_GT(change, RepeatedPicture::kFraction * large) << n;
      ASSERT_LT(change, RepeatedPicture::kFractionWhenDue * large) << n;
    } else {
      large = change;
    }
    const Kind kind = repeated.compare(before.view(), now.view());
    if (n > RepeatedPicture::kFrames) {
      EXPECT_EQ(kind, again ? Kind::kAlike : Kind::kOther) << n;
    }
    if (kind == Kind::kOther) before = now;
  }
}

TEST(RepeatedPicture, TheSameNoiseOutOfRhythmIsAnotherPicture) {
  RepeatedPicture repeated;
  Picture before = moved(0, 1, 5);
  double position = 0;
  for (uint32_t n = 1; n < 60; ++n) {
    // Standing for a frame now and then, never twice after the same time.
    const bool stands = n == 9 || n == 22 || n == 28 || n == 43;
    if (!stands) position += 4;
    const Picture now = moved(position, n + 1, 5);
    EXPECT_EQ(repeated.compare(before.view(), now.view()), Kind::kOther) << n;
    before = now;
  }
}

TEST(RepeatedPicture, LittleNoiseIsTheSamePictureOutOfRhythmToo) {
  RepeatedPicture repeated;
  Picture before = moved(0, 1);
  double position = 0;
  float large = 0;
  int stood = 0;
  int gap = 3;  // pictures from one repeat to the next: 3, 4, 5, 6, 3 ...
  for (uint32_t n = 1, since = 0; n < 80; ++n) {
    const bool stands = ++since == static_cast<uint32_t>(gap);
    if (stands) {
      since = 0;
      gap = gap == 6 ? 3 : gap + 1;
      ++stood;
    } else {
      position += 4;
    }
    const Picture now = moved(position, n + 1);
    const float change = largest_change(before.view(), now.view());
    if (stands) {
      ASSERT_LT(change, RepeatedPicture::kFraction * large) << n;
    } else {
      large = change;
    }
    const Kind kind = repeated.compare(before.view(), now.view());
    if (stood > RepeatedPicture::kMinDips) {
      EXPECT_EQ(kind, stands ? Kind::kAlike : Kind::kOther) << n;
    }
    if (kind == Kind::kOther) before = now;
  }
}

TEST(RepeatedPicture, OneBlockIsNoiseAndSeveralAreAnObject) {
  const Picture before = moved(0);
  Picture accident = before;
  for (int x = 32; x < 48; ++x) accident.at(x, 40) = 255;
  Picture object = before;
  for (int x = 32; x < 96; ++x) {
    for (int y = 32; y < 64; ++y) object.at(x, y) = 255;
  }
  // The picture has levels from 60 to 187, which is 68 to 195 below white.
  EXPECT_LE(largest_change(before.view(), accident.view()), 195.0f / 16 / kChangedBlocks);
  EXPECT_GE(largest_change(before.view(), object.view()), 68);
}

}  // namespace
}  // namespace spidar::test::repeated_picture_test
