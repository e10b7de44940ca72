// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Windows of blocks are found in the frame to a few hundredths of a pixel of it.
#include <numeric>

#include "core/field/fine_windows.h"
#include "core/picture/reduced_frame.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::fine_windows_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

Picture moved(const Vector2d& by_px, double gain = 1, double offset = 0) {
  static const Texture texture(3, 12);
  Picture picture(kWidth, kHeight);
  picture.fill([&](double x, double y) {
    return std::clamp(gain * texture.at(x - by_px.x(), y - by_px.y()) + offset, 0.0, 255.0);
  });
  return picture;
}

/// A field and the windows of its blocks that are wanted.
struct Fine {
  ReducedFrame reduced;
  BlockField field;
  FineWindows windows;
  FieldPosition position;

  void see(const Picture& picture) {
    reduced.read(picture.view());
    field.update(reduced.base());
    position.scale = reduced.factor() * field.scale();
    position.centre_px = {(position.scale * field.picture().width() - 1) / 2,
                          (position.scale * field.picture().height() - 1) / 2};
  }
  void keep_all(const Picture& picture) {
    std::vector<size_t> blocks(field.blocks().size());
    std::iota(blocks.begin(), blocks.end(), size_t{0});
    windows.store(picture.view(), field, position, blocks);
  }
};

/// The largest error of a window, px of the frame; all that are inside must be found.
double worst_px(const Picture& before, const Picture& now, const Vector2d& by_px) {
  Fine fine;
  fine.see(before);
  fine.keep_all(before);
  fine.see(now);
  const auto& found = fine.windows.find(now.view(), fine.field, fine.position);
  EXPECT_GT(found.size(), FineWindows::kMax / 2);
  double worst = 0;
  for (const FineMotion& window : found) {
    worst = std::max(worst, (fine.position.scale * window.moved_px - by_px).norm());
  }
  return worst;
}

/// Grey levels are rounded in both pictures: five deviations of √(2/12) over 256 pixels of the
/// weakest texture that is kept, 0.2 (grey / px)², are 0.29 px; of the texture here, which is above
/// 4, a fifth of that. Interpolation between pixels adds less than that.
constexpr double kTolerance_px = 0.06;

TEST(FineWindows, AreFoundToAFewHundredthsOfAPixelOfTheFrame) {
  for (const Vector2d& by_px : {Vector2d(0, 0), Vector2d(7.3, -4.6), Vector2d(-20.5, 11.25)}) {
    EXPECT_LT(worst_px(moved({0, 0}), moved(by_px), by_px), kTolerance_px) << by_px.transpose();
  }
}

TEST(FineWindows, AreNeverMoreThanThereIsRoomFor) {
  Fine fine;
  const Picture picture = moved({0, 0});
  fine.see(picture);
  const BlockGrid& grid = fine.field.grid();
  const size_t block = grid.index(grid.columns / 2, grid.rows / 2);
  // Of 97, every second one is 49.
  for (const size_t count : {FineWindows::kMax, 2 * FineWindows::kMax + 1}) {
    fine.windows.store(picture.view(), fine.field, fine.position,
                       std::vector<size_t>(count, block));
    EXPECT_EQ(fine.windows.find(picture.view(), fine.field, fine.position).size(),
              FineWindows::kMax);
  }
}

TEST(FineWindows, ABrightnessCommonToAllPixelsIsNoMotion) {
  const Vector2d by_px(3.4, 1.7);
  EXPECT_LT(worst_px(moved({0, 0}, 0.8), moved(by_px, 0.8, 20), by_px), kTolerance_px);
}

TEST(FineWindows, WhatShowsSomethingElseOrTooLittleIsLeftOut) {
  Fine fine;
  const Picture before = moved({0, 0});
  fine.see(before);
  fine.keep_all(before);
  const Picture now = moved({501.3, 333.7});  // unrelated
  fine.see(now);
  const size_t lucky = fine.windows.find(now.view(), fine.field, fine.position).size();
  EXPECT_LT(lucky, FineWindows::kMax / 8);
  Picture plain(kWidth, kHeight);
  plain.fill([](double, double) { return 100.0; });
  fine.keep_all(plain);
  fine.see(plain);
  EXPECT_TRUE(fine.windows.find(plain.view(), fine.field, fine.position).empty());
}

}  // namespace
}  // namespace spidar::test::fine_windows_test
