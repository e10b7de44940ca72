// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What is felt of an object that has most of the picture, as a face or an animal that the camera
// follows from near by.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/camera/border.h"
#include "tests/core/field_film.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::large_object_test {
namespace {

constexpr int kFrames = 16;
/// Contrast of a wall that hardly any block shows.
constexpr double kOutOfFocus = 0.1;

/// A wall that moves by `pan_px` a frame, and before it an object that the lower border cuts. It
/// has three fifths of the picture; the wall has three quarters of the blocks along the border.
struct CloseFilm {
  Eigen::Vector2d pan_px;
  Eigen::Vector2d object_px;
  double wall_contrast = 0.5;

  double operator()(int n, const Eigen::Vector2d& at_px) const {
    static const Texture wall(1, 5), object(2, 5);
    const Eigen::Vector2d of_object_px = at_px - n * object_px;
    const Eigen::AlignedBox2d box_px(Eigen::Vector2d(92, 60),
                                     Eigen::Vector2d(548, 2 * kSceneHeight));
    if (box_px.contains(of_object_px)) return object.at(of_object_px.x(), of_object_px.y());
    const Eigen::Vector2d of_wall_px = at_px - n * pan_px;
    return 128 + wall_contrast * (wall.at(of_wall_px.x(), of_wall_px.y()) - 128);
  }
};

struct Right {
  int camera = 0;
  int felt = 0;
};

/// In how many pictures the camera is right to a pixel, and what is felt to 30° and a factor of 2,
/// as tests/bench/real_films.py counts it.
Right right_in(const CloseFilm& film) {
  MotionAnalyzer analyzer;
  Right right;
  const Eigen::Vector2d true_px = film.object_px - film.pan_px;
  for (int n = 0; n < kFrames; ++n) {
    const Frame& frame = analyzer.analyze(draw(film, n).view(), n * kSceneFrame_ns);
    if (!frame.background) continue;
    right.camera += (frame.background->model.displacement_px({0, 0}) - film.pan_px).norm() < 1;
    const Eigen::Vector2d px = frame.motion.velocity_px_s * kSceneFrame_s;
    const double ratio = px.norm() / true_px.norm();
    const double cosine = px.dot(true_px) / std::max(px.norm() * true_px.norm(), 1e-9);
    right.felt += ratio > 0.5 && ratio < 2 && cosine > std::cos(M_PI / 6);
  }
  return right;
}

/// In more pictures than not; as the votes say, it would be in none.
constexpr int kMax = (kFrames - 1) / 2;

TEST(LargeObject, IsNotTakenForTheCamera) {
  for (const CloseFilm& film : {CloseFilm{{-4, 2}, {0, -1}}, CloseFilm{{0, 0}, {3, 0}},
                                CloseFilm{{6, 0}, {1, 0}, kOutOfFocus}}) {
    const Right right = right_in(film);
    EXPECT_GT(right.camera, kMax) << film.pan_px.transpose();
    EXPECT_GT(right.felt, kMax) << film.pan_px.transpose();
  }
}

TEST(Border, IsSharedByTheModelsThatFit) {
  const Texture texture(1, 6);
  BlockField field;
  const Eigen::Vector2d moved_px(6, 0);
  for (int n = 0; n < 2; ++n) {
    Picture picture(kFieldWidth, kFieldHeight);
    // The left half rests.
    picture.fill([&](double x, double y) {
      return texture.at(x - (x < kFieldWidth / 2 ? 0 : n * moved_px.x()), y);
    });
    field.update(padded(picture));
  }
  const MotionModel rest, moves = background_moved_by(moved_px).model,
                          another = background_moved_by({0, 7}).model;
  std::vector<double> shares;
  // Of one, what counts is what it does not explain: the other half, but for what was outside.
  EXPECT_NEAR(divide_border(field, nothing_before(), {rest}, shares), 0.5, 0.1);
  EXPECT_GT(divide_border(field, nothing_before(), {rest, moves, another}, shares), 0.9);
  EXPECT_NEAR(shares[0], 0.5, 0.1);
  EXPECT_NEAR(shares[1], 0.5, 0.1);
  EXPECT_LT(shares[2], 0.05);
  // Two that are the same have half each.
  divide_border(field, nothing_before(), {rest, moves, rest}, shares);
  EXPECT_NEAR(shares[0], 0.25, 0.05);
  EXPECT_EQ(shares[0], shares[2]);
}

TEST(Border, LeavesOutGraphics) {
  // They stay at the left and at the right of a pan.
  constexpr double kWide_px = 40;
  const Texture film(1, 6), graphics(2, 6);
  BlockField field;
  const Eigen::Vector2d moved_px(6, 0);
  for (int n = 0; n < 2; ++n) {
    Picture picture(kFieldWidth, kFieldHeight);
    picture.fill([&](double x, double y) {
      const bool is_film = x >= kWide_px && x < kFieldWidth - kWide_px;
      return is_film ? film.at(x - n * moved_px.x(), y) : graphics.at(x, y);
    });
    field.update(padded(picture));
  }
  const MotionModel rest, moves = background_moved_by(moved_px).model;
  // Of two blocks along each border, those that they cover.
  const BlockGrid& grid = field.grid();
  const double inner = (grid.columns - 4) * (grid.rows - 4);
  const double of_graphics = 4 * grid.rows / (static_cast<double>(grid.size()) - inner);
  std::vector<double> shares;
  EXPECT_NEAR(divide_border(field, nothing_before(), {moves, rest}, shares), 1 - of_graphics, 0.1);
  EXPECT_LT(shares[1], 0.05);
  EXPECT_LT(divide_border(field, nothing_before(), {moves}, shares), 0.05);
  // Beside a camera at rest nothing tells them from the scene.
  divide_border(field, nothing_before(), {rest, moves}, shares);
  EXPECT_NEAR(shares[0], of_graphics, 0.1);
}

}  // namespace
}  // namespace spidar::test::large_object_test
