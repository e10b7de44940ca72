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

/// Finds how many rows and columns of blocks at each side of the picture do not show the film, but
/// letterbox bars, a still frame around the film, or both. A block that contains the edge of the
/// film counts as part of a bar. The outer blocks inside the bars are then the border.
///
/// Lines (rows or columns) of blocks that stay the same are a bar if nearly the whole next line
/// changes: the edge of a film is straight, but the edge of an object in front of a still wall is
/// not. A bar must be as wide as the one on the opposite side, to within a block. Bars are known
/// when kKnownAfterPairs pairs of pictures have shown them, and until something in them changes.
class Margins {
 public:
  void update(const BlockField& field);

  /// The number of columns in the bar at either side, and of rows in the bar at the top or bottom.
  int columns() const { return columns_.is_known() ? columns_.blocks : 0; }
  int rows() const { return rows_.is_known() ? rows_.blocks : 0; }

  /// Whether the last update() found or lost bars, so that the film has another border than before.
  bool have_changed() const { return have_changed_; }

  bool contains(const BlockGrid& grid, size_t block) const {
    return grid.columns_beside(block) < columns() || grid.rows_beside(block) < rows();
  }

  void reset();

  /// The number of pairs of pictures after which bars are known: in one or two pairs, an object may
  /// look like a bar.
  static constexpr int kKnownAfterPairs = 3;

 private:
  struct Bars {
    int blocks = 0;
    int pairs = 0;  ///< number of pairs of pictures that showed the bars
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

/// Detects burned-in graphics, such as a logo, a subtitle, a clock, the edge of a letterbox bar or
/// a still inset picture. While the camera moves, they move against the background, as objects do.
/// Three signs distinguish a block with graphics from one with an object.
///
/// First, its pixels are constant. Graphics are added after the film was shot, and lack the noise
/// of the film; the pixels of an object that the camera follows always change.
///
/// Second, nothing explains its pixels as well as those of the blocks around it, neither rest nor a
/// motion: the film shows through semi-transparent graphics, while their edges stay in place. An
/// object that begins to deform looks the same, so this sign does not count where an object is
/// known.
///
/// Third, the block seems to move a little against the background, but some of its pixels stay in
/// place.
///
/// In a film without noise, such as a cartoon, everything that stands exactly still in front of a
/// moving background counts as burned in.
class BurnedIn {
 public:
  struct Block {
    size_t index = 0;
    Eigen::Vector2f background_px;  ///< motion of the background at this position
    bool is_slow = false;           ///< moves nearly like the background
    bool is_expected = false;       ///< belongs to a known object
  };

  /// Begins a pair of pictures. Constant pixels belong to the scene if the camera does not move.
  void begin(const BlockField& field, bool camera_moves);

  /// Examines a block of the pair. Call this for every block that seems to move independently.
  void classify(const BlockField& field, const Block& block);

  /// Ends the pair. A block that was constant in two pairs stays burned in for some further ones,
  /// in which the digits of a clock may change, and makes unexplained blocks next to it count as
  /// burned in.
  void end(const BlockGrid& grid);

  /// Whether a block shows burned-in graphics; false for a block that no recent pair examined.
  bool contains(size_t index) const { return index < contained_.size() && contained_[index] != 0; }
  /// contains() for all blocks, 1 or 0; empty before the first pair.
  const std::vector<uint8_t>& held() const { return contained_; }

  /// Whether lasting graphics are in a block or next to it. They cover the film, and the motion
  /// behind them is unknown. This is stricter than contains(), because a sign in a single pair may
  /// be an error.
  bool occludes(size_t index) const { return index < occluded_.size() && occluded_[index] != 0; }

  /// Bars and still frames around the film, which count as burned in also while the camera is
  /// still.
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
  std::vector<uint8_t> lasting_;  ///< for each block, its score, 0 … kMaxScore
  std::vector<uint8_t> contained_;
  std::vector<uint8_t> occluded_;
  bool camera_moves_ = false;
  std::vector<float> nearby_;  ///< residuals of the background around a block
};

}  // namespace spidar
