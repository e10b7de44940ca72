// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_kernels.h"
#include "core/field/block_search.h"
#include "core/picture/padded_image.h"

namespace spidar {

/// The ratio of the sides of the picture to those of the coarse picture, in which BlockField
/// searches for large displacements.
constexpr int kCoarser = 4;

/// How much smaller the picture of a BlockField is than the base of the pyramid.
enum class FieldScale { kSame, kTwoThirds, kHalf };

/// The scale, 1, 2/3 or 1/2 of the sides, that brings the picture's area nearest to kFieldArea_px2
/// without making a side shorter than kMinSide_px.
FieldScale field_scale(int base_width, int base_height);

/// The side of a pixel of the picture, in pixels of the base: 1, 1.5 or 2.
double pixels_to_one(FieldScale scale);

/// Writes the reduced `base` to `picture`. With kTwoThirds each pixel is the rounded mean of the
/// pixels that it covers; columns and rows that do not fill a pixel are left out.
void reduce_to_field(const PaddedImage& base, FieldScale scale, PaddedImage& picture);

void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced);

/// When the brightness of the whole picture has changed (a flickering lamp, a fade, a shutter),
/// adapts the previous picture to the new brightness: both `coarse_before`, whose comparison with
/// `coarse_now` shows the change, and `before`. Does nothing unless this makes the two pictures
/// more alike.
void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before);

/// The maximum number of pictures that are kept before the last one.
constexpr int kMaxBack = 4;

/// The pictures at a quarter of the resolution, and the origin of each of their blocks.
struct CoarseField {
  PaddedImage before;
  PaddedImage now;
  BlockGrid grid;
  std::vector<BlockMatch> matches;
};

/// Measures the motion of the blocks between two pictures of about 427 × 240 px: BlockSearch finds
/// it in whole pixels, and refined_block() refines it.
class BlockField {
 public:
  enum class Result {
    kFirst,  ///< nothing to compare with: the first picture, or one of another size
    kCut,    ///< a different picture; as with kFirst, all blocks stand still
    kMoved,
  };

  /// `base` is the frame reduced by a power of 2.
  Result update(const PaddedImage& base);

  /// Repeats the picture: all blocks stand still.
  void set_still();

  void reset() { has_picture_ = false; }
  bool has_picture() const { return has_picture_; }

  const PaddedImage& picture() const { return now_; }
  /// The previous picture, adapted to the brightness of picture().
  const PaddedImage& before() const { return earlier_.front(); }
  const CoarseField& coarse() const { return coarse_; }
  const BlockGrid& grid() const { return grid_; }
  /// Blocks of the last update(), row by row.
  const std::vector<MotionBlock>& blocks() const { return blocks_; }
  /// Noise of the two pictures, grey²: the largest residual in the third of the blocks with the
  /// smallest residuals.
  float noise_grey2() const { return noise_grey2_; }
  /// The side of a pixel of the picture, in pixels of the base.
  double scale() const { return pixels_to_one(scale_); }

  enum class Match : uint8_t {
    kPlain,  ///< its pixels differ from their mean by less than a doubtful match
    kFound,
    kLost,  ///< its best match shows something else
  };
  Match match_of(size_t block) const;
  /// Whether more of the blocks for which `counts(block)` holds are lost than found.
  template <typename Counts>
  bool are_lost(Counts&& counts) const {
    int lost = 0;
    int found = 0;
    for (size_t i = 0; i < blocks_.size(); ++i) {
      if (!counts(i)) continue;
      const Match match = match_of(i);
      lost += match == Match::kLost;
      found += match == Match::kFound;
    }
    return lost > found;
  }

  /// The grid block of the previous picture that is nearest to the origin of block `index`.
  size_t origin_of(size_t index) const;

  /// Σ |now − before| of a block if it had moved by `moved_px`: the smaller of the values at the
  /// exact position and at the nearest whole pixels. Negative when the position is out of reach.
  int difference_if_moved(size_t block, const Eigen::Vector2f& moved_px) const;

  /// How many pictures of this shot before the last one are known, kMaxBack at most; 0 while all
  /// blocks stand still because the last picture is repeated.
  int pictures_back() const { return stands_still_ ? 0 : pictures_back_; }
  /// How much better the picture `back` pictures ago fits a block that has come from `from_px` away
  /// than one that has stayed in place, as a difference of the block's cells: positive if the block
  /// has moved. Returns nothing if the block would have come from outside the picture.
  std::optional<int> cell_difference_gain(size_t block, int back,
                                          const Eigen::Vector2i& from_px) const;

  /// Pixels of a block, or of the block `beside_px` beside it, that stayed in place while their
  /// surroundings moved by `moved_px`; none when that motion leads out of reach.
  StayingPixels staying_pixels(size_t block, const Eigen::Vector2f& moved_px,
                               const Eigen::Vector2i& beside_px = {0, 0}) const;

 private:
  void resize(const PaddedImage& base);
  void reduce(const PaddedImage& base);
  void begin();
  void find_hints();
  bool is_cut();
  int contrast_of(size_t block) const;
  bool is_in_reach(const Eigen::Vector2i& corner_px) const;
  void measure_noise();

  FieldScale scale_ = FieldScale::kSame;
  int base_width_ = 0;
  int base_height_ = 0;
  bool has_picture_ = false;
  std::array<PaddedImage, kMaxBack> earlier_;  ///< the latest first
  int pictures_back_ = 0;
  bool stands_still_ = false;
  PaddedImage now_;
  BlockGrid grid_;
  BlockSearch search_;
  CoarseField coarse_;
  std::vector<BlockMatch> hints_;
  std::vector<BlockMatch> matches_;
  std::vector<MotionBlock> blocks_;
  /// The squares of Σ |now − before| and of Σ |pixel − mean| of a block with texture.
  struct Textured {
    double difference2;
    double contrast2;
  };
  std::vector<Textured> textured_;
  std::vector<float> residuals_;
  float noise_grey2_ = 0;
};

}  // namespace spidar
