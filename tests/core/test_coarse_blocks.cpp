// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How the coarse blocks of a picture out of focus move, and what its plain parts and its border
// show.
#include "core/field/coarse_blocks.h"
#include "core/motion/camera/border.h"
#include "core/motion/camera/camera_choice.h"
#include "tests/core/field_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::coarse_blocks_test {
namespace {

/// Of a wall out of focus, of which `stains` is the contrast, that has moved by `moved_px`; with
/// noise of a standard deviation of one grey level, or another one.
PaddedImage wall(double stains, const Eigen::Vector2d& moved_px, uint32_t seed,
                 double noise_grey = 1) {
  const Texture texture(1, 24);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_grey);
  Picture picture(kFieldWidth, kFieldHeight);
  picture.fill([&](double x, double y) {
    const double stain = texture.at(x - moved_px.x(), y - moved_px.y()) - 128;
    return 128 + stains * stain + noise(random);
  });
  return padded(picture);
}

const Eigen::Vector2d kPan_px(5, -2);

/// After so many pictures of a pan.
BlockField field_after(int pictures, double stains, const Eigen::Vector2d& pan_px) {
  BlockField field;
  for (int n = 0; n < pictures; ++n) {
    field.update(wall(stains, n * pan_px, static_cast<uint32_t>(n)));
  }
  return field;
}

TEST(CoarseBlocks, MoveAsThePictureDoesWhereNoBlockShowsIt) {
  BlockField field = field_after(2, 0.4, kPan_px);
  size_t corners = 0;
  for (const MotionBlock& block : field.blocks()) corners += block.has_corners();
  ASSERT_LT(corners, field.blocks().size() / 20);
  CoarseBlocks coarse;
  const std::vector<MotionBlock>& found = coarse.find(field);
  // Four by four blocks each, half overlapping.
  ASSERT_EQ(found.size(),
            static_cast<size_t>((field.grid().columns / 2 - 1) * (field.grid().rows / 2 - 1)));
  size_t right = 0;
  for (const MotionBlock& block : found) {
    // A tenth of a pixel, as of blocks, but of the coarse picture.
    right += (block.moved_px.cast<double>() - kPan_px).norm() < 0.1 * kCoarser;
  }
  // Those of the two borders that the picture leaves were not whole before.
  EXPECT_GT(right, found.size() * 3 / 4);
  field.set_still();
  EXPECT_TRUE(coarse.find(field).empty());
}

TEST(CoarseBlocks, DoNotFollowWhatShowsItsOwnMotion) {
  // A square that rests has four by four blocks; the coarse blocks around it contain some of them.
  const Texture texture(2, 6);
  BlockField field;
  constexpr int kSide_px = kCoarser * kBlock_px;
  const BlockGrid grid = BlockGrid::over(kFieldWidth, kFieldHeight);
  const Eigen::Vector2i from_px = grid.corner_of(grid.index(11, 5));
  for (int n = 0; n < 2; ++n) {
    PaddedImage picture = wall(0.4, n * kPan_px, static_cast<uint32_t>(n));
    for (int y = from_px.y(); y < from_px.y() + kSide_px; ++y) {
      for (int x = from_px.x(); x < from_px.x() + kSide_px; ++x) {
        picture.row(y)[x] = static_cast<uint8_t>(texture.at(x, y));
      }
    }
    field.update(picture);
  }
  const Eigen::Vector2d middle_px = from_px.cast<double>() +
                                    Eigen::Vector2d::Constant(kSide_px / 2.0) -
                                    Eigen::Vector2d(kFieldWidth, kFieldHeight) / 2;
  int partly = 0;
  int like_wall = 0;
  CoarseBlocks coarse;
  for (const MotionBlock& block : coarse.find(field)) {
    const Eigen::Vector2d beside_px = block.centre_px.cast<double>() - middle_px;
    const double apart_px = beside_px.cwiseAbs().maxCoeff();
    if (apart_px > kSide_px || apart_px < kSide_px / 2.0) continue;
    ++partly;
    const Eigen::Vector2d moved_px = block.moved_px.cast<double>();
    like_wall += (moved_px - kPan_px).norm() < moved_px.norm();
  }
  ASSERT_GT(partly, 8);
  EXPECT_EQ(like_wall, partly);
}

TEST(PlainParts, TellAPanFromRestAndFromNoise) {
  const MotionModel pan = background_moved_by(kPan_px).model;
  const auto have_moved = [&](double stains, const Eigen::Vector2d& moved_px) {
    const BlockField field = field_after(kMaxBack + 1, stains, moved_px);
    PlainParts plain;
    for (int n = 1; n < kMaxBack; ++n) plain.remember(field, pan);
    return plain.have_moved(field, nothing_before(), pan);
  };
  EXPECT_TRUE(have_moved(0.1, kPan_px));
  EXPECT_FALSE(have_moved(0.1, {0, 0}));
  EXPECT_FALSE(have_moved(0, {0, 0}));
}

TEST(PlainParts, AreComparedWithPicturesBeforeARepeatedOne) {
  BlockField field = field_after(3, 0.1, kPan_px);
  EXPECT_EQ(field.pictures_back(), 2);
  field.set_still();
  EXPECT_EQ(field.pictures_back(), 0);
  field.update(wall(0.1, 3 * kPan_px, 3));
  EXPECT_EQ(field.pictures_back(), 3);
}

TEST(Border, TellsAPanFromRest) {
  const MotionModel pan = background_moved_by(kPan_px).model;
  EXPECT_TRUE(border_has_moved(field_after(2, 0.4, kPan_px), nothing_before(), pan));
  EXPECT_FALSE(border_has_moved(field_after(2, 0.4, {0, 0}), nothing_before(), pan));
}

TEST(Border, SaysNothingInNoise) {
  // Of two pixels there is less noise halfway between them.
  BlockField field;
  for (const uint32_t seed : {1u, 2u}) field.update(wall(0, {0, 0}, seed, 3));
  const MotionModel pan = background_moved_by({4.5, -2.5}).model;
  EXPECT_FALSE(border_has_moved(field, nothing_before(), pan));
}

TEST(Border, IsNotThatOfAnObject) {
  const BlockField field = field_after(2, 0.4, kPan_px);
  const BlockGrid& grid = field.grid();
  const MotionModel pan = background_moved_by(kPan_px).model;
  const auto has_moved_beside = [&](int columns, int rows) {
    std::vector<uint32_t> objects(grid.size());
    for (size_t i = 0; i < objects.size(); ++i) {
      objects[i] = grid.column(i) < columns && grid.row(i) < rows;
    }
    const PreviousFrame past{nothing_before().foreground, nothing_before().burned_in, objects};
    return border_has_moved(field, past, pan);
  };
  EXPECT_TRUE(has_moved_beside(grid.columns / 3, grid.rows / 3));
  // It leaves less of the border than it has.
  EXPECT_FALSE(has_moved_beside(grid.columns - 1, grid.rows - 1));
  // Nor is it an object that three borders cut.
  EXPECT_TRUE(has_moved_beside(grid.columns - 1, grid.rows));
}

}  // namespace
}  // namespace spidar::test::coarse_blocks_test
