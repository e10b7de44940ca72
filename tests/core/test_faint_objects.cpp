// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Objects that show little of themselves: slow ones, small ones, and those that leave.
#include "tests/core/field_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::faint_objects_test {
namespace {

using Eigen::Vector2d;

/// So fine that a block of it shows motion to a tenth of a pixel.
const Texture kWall(1, 5);
const Texture kCover(2, 5);
/// With the least noise that is ever assumed.
const Background kAtRest = background_moved_by({0, 0}, kSharedError_px);
const Vector2d kMiddle_px(kFieldWidth / 2.0, kFieldHeight / 2.0);

/// A disc whose middle is at `centre_px(n)` in front of a wall at rest.
Scene disc(double radius_px, std::function<Vector2d(int n)> centre_px) {
  return [=](int n, const Vector2d& at) {
    const Vector2d on = at - centre_px(n);
    return on.norm() < radius_px ? kCover.at(on.x(), on.y()) : kWall.at(at.x(), at.y());
  };
}

/// The only object of a frame, by what it moves in it, px; no motion where there is none in sight.
Vector2d moved_px(const std::vector<MovingObject>& objects) {
  if (objects.size() != 1 || objects[0].points == 0) return Vector2d::Zero();
  return objects[0].relative_px_s * kSceneFrame_s;
}

TEST(FaintObjects, ADiscThatGoesByLessThanHalfAPixelIsOne) {
  // The whole pixels nearest to its motion are those of rest: only the structure tensor tells them
  // apart.
  const Vector2d step_px(0.45, 0);
  const auto found =
      objects_in(disc(40, [&](int n) { return kMiddle_px + n * step_px; }), 8, kAtRest);
  for (size_t n = 4; n < found.size(); ++n) {
    EXPECT_LT((moved_px(found[n]) - step_px).norm(), 0.25 * step_px.norm()) << n;
  }
}

TEST(FaintObjects, OneOfASingleBlockIsFoundWhenItHasLasted) {
  // A square of 12 px in the middle of a row of blocks of 16 px, which begins at the upper border.
  const Vector2d step_px(1.5, 0);
  const auto square = [&](int n, const Vector2d& at) {
    const Vector2d on = at - Vector2d(100, 7.5 * kBlock_px) - n * step_px;
    return on.cwiseAbs().maxCoeff() < 6 ? kCover.at(on.x(), on.y()) : kWall.at(at.x(), at.y());
  };
  const auto found = objects_in(square, 25, kAtRest);
  for (size_t n = 0; n < 4; ++n) EXPECT_EQ(moved_px(found[n]).x(), 0) << "it may be an error";
  // It stands out for long enough after four frames, and has shown enough blocks after eight more.
  // Where it is on two blocks alike, neither may show it.
  int right = 0;
  for (size_t n = 12; n < found.size(); ++n) {
    right += (moved_px(found[n]) - step_px).norm() < kAlikeFraction * step_px.norm();
  }
  EXPECT_GE(right, 6);
}

/// Whether the only object of a film has left when it is out of sight for the first time.
bool has_left(const Scene& scene, int frames) {
  for (const auto& objects : objects_in(scene, frames, kAtRest)) {
    if (!objects.empty() && objects[0].points == 0) return objects[0].has_left;
  }
  ADD_FAILURE() << "it is never out of sight";
  return false;
}

TEST(FaintObjects, WhatGoesOutOfThePictureHasLeftAndWhatIsHiddenHasNot) {
  const auto rightwards = [](int n) { return Vector2d(320 + 8 * n, kMiddle_px.y()); };
  EXPECT_TRUE(has_left(disc(30, rightwards), 22));
  const auto behind_a_post = [&](int n, const Vector2d& at) {
    const bool is_post = at.x() > 200 && at.x() < 300;
    const double right_px = 80 + 8.0 * n;
    return is_post ? kWall.at(at.x(), at.y())
                   : disc(30, [&](int) { return Vector2d(right_px, kMiddle_px.y()); })(n, at);
  };
  EXPECT_FALSE(has_left(behind_a_post, 28));
}

}  // namespace
}  // namespace spidar::test::faint_objects_test
