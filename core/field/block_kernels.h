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

namespace vectors {
/// Σ |a − b|. Stops after half of the rows when these alone reach `limit`, and then returns their
/// sum.
int block_difference(BlockPixels a, BlockPixels b, int limit);

/// Σ |now − before|, `before` read `fraction_x`, `fraction_y` (0 … kFractionOne) of a pixel to the
/// right and below, interpolated and rounded to whole grey levels. Reads one column and row more.
int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y);

/// Reads one pixel around both blocks.
BlockSums compare_blocks(BlockPixels now, BlockPixels before);
}  // namespace vectors

/// The same by their definition.
namespace plain {
int block_difference(BlockPixels a, BlockPixels b, int limit);
int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y);
BlockSums compare_blocks(BlockPixels now, BlockPixels before);
}  // namespace plain

}  // namespace spidar
