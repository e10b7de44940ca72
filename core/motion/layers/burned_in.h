// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"

namespace spidar {

/// Finds how many rows and columns of blocks at each side of the picture do not show the film:
/// letterbox bars, a still frame around the film, or both. The blocks that their edge crosses count
/// as bars. The edge of the film then takes the part of the picture's border.
///
/// Lines (rows or columns) of blocks that stay the same are a bar if nearly the whole line next to
/// them changes: the edge of a film is straight, but that of an object in front of a still wall is
/// not. A bar must be as wide as the one on the opposite side, to within a block. A bar is known
/// after kKnownAfterPairs such pairs of pictures, until something in it changes.
class Margins {
 public:
  void update(const BlockField& field);

  /// Number of blocks at the left and at the right, and at the top and at the bottom.
  int columns() const { return columns_.is_known() ? columns_.blocks : 0; }
  int rows() const { return rows_.is_known() ? rows_.blocks : 0; }

  /// Whether update() has found or lost bars: the film has another border than before.
  bool have_changed() const { return have_changed_; }

  bool contains(const BlockGrid& grid, size_t block) const {
    return grid.columns_beside(block) < columns() || grid.rows_beside(block) < rows();
  }

  void reset();

  /// The number of pairs after which bars are known: in one or two, an object may look like a bar.
  static constexpr int kKnownAfterPairs = 3;

 private:
  struct Bars {
    int blocks = 0;
    int pairs = 0;  ///< of pictures that showed the bars
    /// Positions along both edges that have changed since the bars were found.
    std::array<std::vector<uint8_t>, 2> changed;

    bool is_known() const { return pairs >= kKnownAfterPairs; }
    void begin(int width);
  };

  static void update_bars(Bars& bars, const BlockField& field, bool are_columns, int across);

  Bars columns_;
  Bars rows_;
  bool have_changed_ = false;
};

/// Detects graphics that are burned into the film: distinguishes blocks with burned-in graphics (a
/// logo, a subtitle, a clock, the edge of a letterbox bar, a still inset picture) from blocks with
/// a moving object. While the camera moves, both move relative to the background.
///
/// Graphics are added after the film was shot, so their pixels stay constant and lack the film's
/// noise, whereas the pixels of an object that the camera follows always change. The film shows
/// through semi-transparent graphics. Their edges stay in place, but neither rest nor any motion
/// explains their pixels as well as those of the blocks around them. An object that begins to
/// deform looks the same, so this sign does not count where an object is known. A third sign is a
/// block that seems to move a little against the background although some of its pixels stay where
/// they are.
///
/// In a film without noise, such as a cartoon, everything that stands exactly still in front of a
/// moving background counts as burned in.
class BurnedIn {
 public:
  struct Block {
    size_t index = 0;
    Eigen::Vector2f background_px;  ///< motion of the background at this position
    bool is_slow = false;           ///< hardly differs from the background
    bool is_expected = false;       ///< belongs to a known object
  };

  /// Begins a pair of pictures. If the camera does not move (`camera_moves` is false), constant
  /// pixels belong to the scene.
  void begin(const BlockField& field, bool camera_moves);

  /// Examines a block of the pair. Call this for every block that seems to move independently.
  void classify(const BlockField& field, const Block& block);

  /// Ends the pair. A block that stayed constant twice keeps its status for some further pairs, in
  /// which the digits of a clock may change, and makes unexplained blocks next to it count as
  /// burned in.
  void end(const BlockGrid& grid);

  /// Whether a block shows burned-in graphics; false for blocks not examined in the latest pairs.
  bool contains(size_t index) const { return index < contained_.size() && contained_[index] != 0; }
  /// contains() for all blocks, 1 or 0; empty before the first pair.
  const std::vector<uint8_t>& held() const { return contained_; }

  /// Whether the graphics in a block, or next to it, have lasted. They cover the film, and the
  /// motion behind them is unknown. Stricter than contains(), because a sign in a single pair may
  /// be an error.
  bool occludes(size_t index) const { return index < occluded_.size() && occluded_[index] != 0; }

  /// Bars and frames around the film count as burned in, also while the camera is still.
  const Margins& margins() const { return margins_; }

  void reset();

 private:
  enum class Sign : uint8_t {
    kNone,
    kUnexplained,  ///< neither noise nor the block's motion explains its pixels
    kInPlace,      ///< kUnexplained, and the block has not moved
    kStays,        ///< its pixels are constant
  };

  std::optional<float> noise_around_grey2(const BlockField& field, const Block& block);
  bool is_unexplained(const BlockField& field, const Block& block, float moved_px);
  bool stays_beside(const BlockField& field, const Block& block) const;

  Margins margins_;
  std::vector<Sign> signs_;
  std::vector<uint8_t> lasting_;  ///< score of how long each block stayed constant, 0 … kMaxScore
  std::vector<uint8_t> contained_;
  std::vector<uint8_t> occluded_;
  bool camera_moves_ = false;
  std::vector<float> nearby_;  ///< residuals of the background around a block
};

}  // namespace spidar
