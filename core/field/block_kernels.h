// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Arithmetic of block motion: everything that runs for each pixel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

/// Side of a block, px of the picture in which motion is measured.
constexpr int kBlock_px = 16;
constexpr int kBlockArea_px = kBlock_px * kBlock_px;

/// Limits of the difference between two pixels, or of the mean difference between the pixels of two
/// blocks, grey levels. Up to kRounding_grey they are equal: pixels are whole grey levels, and an
/// encoder changes unchanged content by less. Up to kDoubtful_grey the difference may be noise and
/// coding alone; from kClear_grey on, the two show different things.
constexpr float kRounding_grey = 0.5f;
constexpr int kDoubtful_grey = 3;
constexpr int kClear_grey = 8;

/// Upper left pixel of a block in a picture. Rows are `stride` bytes apart.
struct BlockPixels {
  const uint8_t* pixels;
  ptrdiff_t stride;
};

/// One pixel, in the unit of the fractions by which bilinear_difference() moves a block.
constexpr int kFractionOne = 16;

/// Σ over a block `now` and the block `before` for comparison. With Δₖ = p(x + k) − p(x − k), twice
/// the derivative of a picture p is Δ₁ + (2 Δ₁ − Δ₂) / 4, rounded down. The derivatives g are those
/// of both pictures together: four times the mean derivative in grey levels a pixel. d is now −
/// before.
struct BlockSums {
  int32_t xx = 0;          ///< Σ gx²
  int32_t xy = 0;          ///< Σ gx gy
  int32_t yy = 0;          ///< Σ gy²
  int32_t x = 0;           ///< Σ gx
  int32_t y = 0;           ///< Σ gy
  int32_t xd = 0;          ///< Σ gx d
  int32_t yd = 0;          ///< Σ gy d
  int32_t difference = 0;  ///< Σ d
  int32_t squared = 0;     ///< Σ d²
  int32_t pixels = kBlockArea_px;

  bool operator==(const BlockSums& o) const {
    return xx == o.xx && xy == o.xy && yy == o.yy && x == o.x && y == o.y && xd == o.xd &&
           yd == o.yd && difference == o.difference && squared == o.squared && pixels == o.pixels;
  }
};

/// Counts the pixels of a block that stayed in place although their surroundings moved: they have
/// changed by at least kClear_grey less than the motion would have changed them.
struct StayingPixels {
  int near = 0;   ///< pixels that have changed by kDoubtful_grey at most
  int exact = 0;  ///< those of them that have not changed at all

  bool operator==(const StayingPixels& o) const { return near == o.near && exact == o.exact; }
};

/// A block that begins between pixels: each pixel is read `fraction_x`, `fraction_y` (0 …
/// kFractionOne) of a pixel further to the right and down.
struct MovedBlock {
  BlockPixels pixels;
  int fraction_x = 0;
  int fraction_y = 0;
};

/// Σ |a − b|. Stops after half of the rows if their sum has reached `limit`, and returns that.
int block_difference(BlockPixels a, BlockPixels b, int limit);

/// Σ |a − b| over the pixels that count: `counted` is 255 there, and 0 at the others.
int block_difference(BlockPixels a, BlockPixels b, BlockPixels counted);

/// Σ |pixel − mean| of a block, with the mean rounded to a whole grey level.
int difference_from_mean(BlockPixels block);

/// Which of the kBlock_px pixels from `row` on have a slope: bit x is set where the squares of the
/// differences of its neighbours, to the left and right and above and below, add up to `least`.
unsigned steep_pixels(BlockPixels row, int least);

/// Side of a cell of a block, px. The mean over a cell has a quarter of the noise of a pixel.
constexpr int kCell_px = 4;

/// Σ |a − b| of the sums over the cells of two blocks.
int cell_difference(BlockPixels a, BlockPixels b);

/// Σ |now − before|, where `before` is read `fraction_x`, `fraction_y` (0 … kFractionOne) of a
/// pixel further to the right and down, interpolated and rounded to whole grey levels. Reads one
/// extra column and row.
int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y);

/// Reads two pixels around both blocks.
BlockSums compare_blocks(BlockPixels now, BlockPixels before);
/// The same over the pixels that count, see block_difference().
BlockSums compare_blocks(BlockPixels now, BlockPixels before, BlockPixels counted);

/// Compares a block `now` with the same position in the picture `before`. If the block had moved
/// with its surroundings, it would have come from `from` in that picture, and what was in its place
/// would have gone to `to` in the new picture. The larger of the two differences counts: something
/// that stays in front of a moving background shows both where the background should have covered
/// it and where it should have uncovered the background. Reads one extra column and row of `from`
/// and `to`.
StayingPixels staying_pixels(BlockPixels now, BlockPixels before, const MovedBlock& from,
                             const MovedBlock& to);
}  // namespace spidar
