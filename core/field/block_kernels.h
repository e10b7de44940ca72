// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The arithmetic of a block of motion: all that is done once a pixel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

/// Side of a block, px of the picture that the field looks at.
constexpr int kBlock_px = 16;
constexpr int kBlockArea_px = kBlock_px * kBlock_px;

/// Upper left pixel of a block in a picture. Rows are `stride` bytes apart.
struct BlockPixels {
  const uint8_t* pixels;
  ptrdiff_t stride;
};

/// Share of a pixel that a block is moved by for bilinear_difference(): of kFractionOne.
constexpr int kFractionOne = 16;

/// Σ over a block `now` and the block `before` that it is compared with. The derivatives g are
/// those of both pictures together: (now(x + 1) − now(x − 1)) + (before(x + 1) − before(x − 1)),
/// four times the mean derivative in grey levels for each pixel. d is now − before.
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

  bool operator==(const BlockSums& o) const {
    return xx == o.xx && xy == o.xy && yy == o.yy && x == o.x && y == o.y && xd == o.xd &&
           yd == o.yd && difference == o.difference && squared == o.squared;
  }
};

/// Pixels of a block that stayed where they were, as if the motion around them were none of theirs.
struct StayingPixels {
  int near = 0;   ///< that have changed by kNear_grey at most
  int exact = 0;  ///< of these, that have not changed at all

  bool operator==(const StayingPixels& o) const { return near == o.near && exact == o.exact; }
};
constexpr int kNear_grey = 3;
/// A pixel stays when the motion would have changed it by so many grey levels more than it changed.
constexpr int kClearlyStays_grey = 8;

/// A block that begins between pixels: each of its pixels is read `fraction_x`, `fraction_y` (0 …
/// kFractionOne) of a pixel to the right and below.
struct MovedBlock {
  BlockPixels pixels;
  int fraction_x = 0;
  int fraction_y = 0;
};

namespace vectors {
/// Σ |a − b|. Stops after half of the rows when these alone reach `limit`, and then returns their
/// sum.
int block_difference(BlockPixels a, BlockPixels b, int limit);

/// Σ |now − before|, `before` read `fraction_x`, `fraction_y` (0 … kFractionOne) of a pixel to the
/// right and below, interpolated and rounded to whole grey levels. Reads one column and row more.
int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y);

/// Reads one pixel around both blocks.
BlockSums compare_blocks(BlockPixels now, BlockPixels before);

/// Compares a block `now` with what is at its place in the picture `before`. `from` is where the
/// motion around it would have brought it from, in the picture before; `to` where it would have
/// brought the block before to, in the picture of now. Of both the larger difference counts: what
/// stays in front of something that moves is seen by what should have been covered, and by what
/// should have been uncovered. Reads one column and row more of `from` and `to`.
StayingPixels staying_pixels(BlockPixels now, BlockPixels before, const MovedBlock& from,
                             const MovedBlock& to);
}  // namespace vectors

/// The same by their definition.
namespace plain {
int block_difference(BlockPixels a, BlockPixels b, int limit);
int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y);
BlockSums compare_blocks(BlockPixels now, BlockPixels before);
StayingPixels staying_pixels(BlockPixels now, BlockPixels before, const MovedBlock& from,
                             const MovedBlock& to);
}  // namespace plain

}  // namespace spidar
