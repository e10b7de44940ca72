// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which window stands for a point: where its gradients are, and on one side of a rim.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/tracking/corner.h"
#include "core/tracking/point_follower.h"
#include "tests/support/picture.h"
#include "tests/support/texture.h"

namespace spidar::test {
namespace {

constexpr int kWidth = 200;
constexpr int kHeight = 160;

template <typename Grey>
PaddedImage image_of(Grey&& grey) {
  Picture picture(kWidth, kHeight);
  picture.fill(grey);
  PaddedImage image;
  reduce_blocks(picture.view(), 1, image);
  image.repeat_border();
  return image;
}

/// A blob of σ = 1 px on grey: its gradients' squares are below a hundredth 3 px away.
PaddedImage blob(double x_px, double y_px) {
  return image_of([=](double x, double y) {
    return 50 + 150 * std::exp(-((x - x_px) * (x - x_px) + (y - y_px) * (y - y_px)) / 2);
  });
}

TEST(CentredCorner, HasItsGradientsInTheMiddle) {
  const PixelBox box{40, 40, 72, 72};
  for (double x_px = 48; x_px < 64; x_px += 1.7) {
    for (double y_px = 48; y_px < 64; y_px += 1.3) {
      const PaddedImage image = blob(x_px, y_px);
      const Corner best = best_corner(image, box);
      ASSERT_GT(best.strength, 0);
      const Corner centred = centred_corner(image, box, best);
      // Moved by whole pixels: half of one is left, and what rounding to grey levels adds.
      EXPECT_NEAR(static_cast<double>(centred.at.x_px), x_px, 0.6) << x_px << ", " << y_px;
      EXPECT_NEAR(static_cast<double>(centred.at.y_px), y_px, 0.6) << x_px << ", " << y_px;
    }
  }
}

TEST(CentredCorner, StaysInItsBox) {
  // The blob's right half is outside.
  const PixelBox box{40, 40, 60, 72};
  const PaddedImage image = blob(60, 56);
  const Corner centred = centred_corner(image, box, best_corner(image, box));
  EXPECT_EQ(centred.at.x_px, 55.5f);  // of the pixels 52 … 59
  EXPECT_NEAR(static_cast<double>(centred.at.y_px), 56, 0.6);
}

TEST(CentredCorner, IsTheOldOneWhereTheMiddleIsAnEdge) {
  // A corner at 51, 43 in the window, and the rest of a strong edge, to which it would move.
  const PaddedImage image = image_of([](double x, double y) {
    const double edge = x < 54 ? 40 : 240;
    return y < 43 && x < 51 ? edge + 12 : edge;
  });
  const Corner corner{{51.5f, 45.5f}, 1};
  const Corner centred = centred_corner(image, {40, 40, 72, 72}, corner, 0.2f);
  EXPECT_EQ(centred.at.x_px, corner.at.x_px);
  EXPECT_EQ(centred.at.y_px, corner.at.y_px);
  EXPECT_EQ(centred.strength, corner.strength);
}

/// What is left of kRim_px moves by `moved_px`, what is right of it rests behind it.
GrayPyramid two_sides(const Texture& left, const Texture& right, double moved_px) {
  constexpr double kRim_px = 100;
  GrayPyramid pyramid;
  pyramid.levels[0] = image_of([&](double x, double y) {
    return x < kRim_px + moved_px ? left.at(x - moved_px, y) : right.at(x, y);
  });
  pyramid.build_from_base();
  return pyramid;
}

FollowedPoint point_at(float x_px, float y_px, bool may_shift) {
  FollowedPoint point;
  point.at = {x_px, y_px};
  point.may_shift = may_shift;
  return point;
}

class Rim : public testing::Test {
 protected:
  /// Points on the rim, after two columns of points on either side of it.
  std::vector<FollowedPoint> follow(double moved_px, bool may_shift) {
    const Texture left(7, 5);
    const Texture right(8, 5);
    const GrayPyramid before = two_sides(left, right, 0);
    const GrayPyramid now = two_sides(left, right, moved_px);
    std::vector<FollowedPoint> points;
    for (const float x_px : {60.5f, 140.5f}) {
      for (float y_px = 20.5f; y_px < kHeight - 20; y_px += 20) {
        points.push_back(point_at(x_px, y_px, may_shift));
      }
    }
    const auto beside = static_cast<std::ptrdiff_t>(points.size());
    for (float y_px = 20.5f; y_px < kHeight - 20; y_px += 5) {
      points.push_back(point_at(99.5f, y_px, may_shift));
    }
    PointFollower().follow(before, now, {}, points);
    return {points.begin() + beside, points.end()};
  }
};

TEST_F(Rim, ANewPointGoesWithOneSide) {
  for (const double moved_px : {4.3, -3.6, 2.5}) {
    size_t found = 0;
    size_t shifted = 0;
    const std::vector<FollowedPoint> points = follow(moved_px, true);
    for (const FollowedPoint& point : points) {
      if (!point.found) continue;
      ++found;
      if (!point.is_shifted) continue;
      ++shifted;
      const double x_px = static_cast<double>(point.match.to.x_px - point.at.x_px);
      // The rim is between pixels 99 and 100: at 99.5 a point may be of either side.
      const bool may_be_left = point.at.x_px < 100;
      const bool may_be_right = point.at.x_px > 99;
      // The larger window that refines it sees some of the other side.
      constexpr double kRight_px = 0.5;
      EXPECT_TRUE((may_be_left && std::abs(x_px - moved_px) < kRight_px) ||
                  (may_be_right && std::abs(x_px) < kRight_px))
          << "of " << moved_px << " px: at " << point.at.x_px << ", " << point.at.y_px << " moved "
          << x_px;
    }
    EXPECT_GE(found, points.size() * 3 / 4) << moved_px;
    EXPECT_GE(shifted, points.size() / 2) << moved_px;
  }
}

TEST_F(Rim, APointWhosePlaceIsKnownStaysThere) {
  for (const FollowedPoint& point : follow(4.3, false)) {
    EXPECT_FALSE(point.is_shifted);
    EXPECT_EQ(point.at.x_px, 99.5f);
  }
}

}  // namespace
}  // namespace spidar::test
