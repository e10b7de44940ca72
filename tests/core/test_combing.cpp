// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Interlaced films that are not flagged as such are recognised by the combs of what moves between
// two fields.
#include "core/field/combing.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::combing_test {
namespace {

using test::Picture;
using test::Texture;

/// A disc of 5 % of the picture that moves by `step_px` from the first field to the second.
Picture fields(double step_px, int width = 640, int height = 480) {
  static const Texture wall(1, 5);
  static const Texture disc(2, 5);
  Picture picture(width, height);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 3);
  const double radius_px = std::sqrt(0.05 * width * height / M_PI);
  picture.fill([&](double x, double y) {
    const double moved_px = static_cast<int>(y) % 2 == 0 ? 0 : step_px;
    const bool inside = std::hypot(x - width / 2.0 - moved_px, y - height / 2.0) < radius_px;
    const double grey = inside ? disc.at(x - moved_px, y) : wall.at(x, y);
    return std::min(255.0, std::max(0.0, grey + noise(random)));
  });
  return picture;
}

/// comb_fraction() pixel by pixel: of every 16 lines the middle four are looked at.
double defined_fraction(const ImageView& picture) {
  int combs = 0;
  int pixels = 0;
  for (int y = 8; y + 4 <= picture.height; y += 16) {
    for (int x = 0; x < picture.width; ++x, ++pixels) {
      const auto step = [&](int from, int to) {
        return *picture.at(x, y + to) - *picture.at(x, y + from);
      };
      const bool returns = std::abs(step(0, 2)) <= 10 && std::abs(step(1, 3)) <= 10;
      const bool up = step(0, 1) > 20 && step(2, 3) > 20;
      const bool down = step(0, 1) < -20 && step(2, 3) < -20;
      combs += returns && (up || down);
    }
  }
  return static_cast<double>(combs) / pixels;
}

TEST(Combing, TheFractionIsThatOfItsDefinition) {
  std::vector<uint8_t> lines;
  std::mt19937 random(1);
  for (const int width : {16, 47, 640}) {
    Picture noise(width, 480);
    noise.fill([&](double, double) { return static_cast<double>(random() % 256); });
    for (const Picture& picture : {noise, fields(6, width)}) {
      const double fraction = defined_fraction(picture.view());
      EXPECT_GT(fraction, 0);
      EXPECT_EQ(comb_fraction(picture.view(), lines), fraction);
    }
  }
}

TEST(Combing, AFilmCountsAsInterlacedFromItsFirstComb) {
  Combing combing;
  const Picture whole = fields(0);
  EXPECT_FALSE(combing.update(whole.view())) << "nothing has moved";
  EXPECT_TRUE(combing.update(fields(6).view()));
  // A telecined film has whole pictures in between, and a still shot shows nothing of its fields.
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(combing.update(whole.view()));
}

TEST(Combing, AFilmThatIsNoLongerInterlacedIsRecognised) {
  Combing combing;
  ASSERT_TRUE(combing.update(fields(6).view()));
  const Picture whole = fields(0);
  int frames = 0;
  while (combing.update(whole.view()) && frames < 1000) ++frames;
  EXPECT_GT(frames, 5 * 24) << "a still part of five seconds";
  EXPECT_LT(frames, 15 * 24);
}

TEST(Combing, LargeFramesAreReducedByOneFieldAnyway) {
  Combing combing;
  EXPECT_FALSE(combing.update(fields(12, 1920, 1080).view()));
}

}  // namespace
}  // namespace spidar::test::combing_test
