// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which blocks vote on the motion of the camera, and how much each vote counts.
#include "core/motion/camera/block_votes.h"
#include "tests/core/field_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::block_votes_test {
namespace {

TEST(BlockVotes, CountTwiceInTheTwoColumnsAndRowsAtEachBorder) {
  const Texture texture(1, 8);
  BlockField field;
  for (const double moved_px : {0.0, 4.0}) {
    Picture picture(kFieldWidth, kFieldHeight);
    picture.fill([&](double x, double y) { return texture.at(x - moved_px, y); });
    field.update(padded(picture));
  }
  BackgroundVotes votes;
  collect_votes(field, nothing_before(), votes);
  const BlockGrid& grid = field.grid();
  const int inner = (grid.columns - 4) * (grid.rows - 4);
  const int border = grid.columns * grid.rows - inner;
  EXPECT_EQ(votes.all, inner + kBorderVotes * border);
  double sum[2] = {};
  int count[2] = {};
  for (const BackgroundVote& vote : votes.cast) {
    const int column = static_cast<int>(vote.source) % grid.columns;
    const int row = static_cast<int>(vote.source) / grid.columns;
    const bool at_border =
        column < 2 || column >= grid.columns - 2 || row < 2 || row >= grid.rows - 2;
    EXPECT_EQ(vote.at_border, at_border) << "column " << column << ", row " << row;
    sum[at_border] += vote.weight;
    ++count[at_border];
  }
  // The texture is alike everywhere; what comes into the picture fits less well.
  EXPECT_GT(sum[true] / count[true], 1.5 * sum[false] / count[false]);
}

/// Whether the votes are lost when as many pixels from the middle show another texture as before,
/// and all around is plain.
bool are_lost(double reach_px) {
  const Texture before(1, 8), after(2, 8);
  BlockField field;
  for (const Texture* texture : {&before, &after}) {
    Picture picture(kFieldWidth, kFieldHeight);
    picture.fill([&](double x, double y) {
      const bool is_inside =
          std::max(std::abs(x - kFieldWidth / 2.0), std::abs(y - kFieldHeight / 2.0)) < reach_px;
      return is_inside ? texture->at(x, y) : 128;
    });
    field.update(padded(picture));
  }
  BackgroundVotes votes;
  collect_edges(field, nothing_before(), votes);
  return votes.are_lost;
}

TEST(BlockVotes, AreNotLostWhereOneThingIsThatIsSmall) {
  // It touches three by three blocks at most, and twelve say something.
  EXPECT_FALSE(are_lost(kBlock_px));
  // Six by six at least.
  EXPECT_TRUE(are_lost(3 * kBlock_px));
}

}  // namespace
}  // namespace spidar::test::block_votes_test
