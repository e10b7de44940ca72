// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the bars or the frame around a film.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/field/block_field.h"

namespace spidar {

/// How many rows and columns of blocks at each side of the picture do not show the film: letterbox
/// bars, a still frame around it, or both, with the blocks through which their edge goes. The
/// border of the film counts as the picture's border.
///
/// Lines (rows or columns) of blocks that stay the same are a bar when next to them nearly the
/// whole line changes: the edge of a film is straight, that of an object in front of a wall at rest
/// is not. A bar is as wide as the one on the opposite side, give or take a block. It is known
/// after kKnownAfterPairs such pairs of pictures, and until something in it changes.
class Margins {
 public:
  /// Compares the two pictures of the field.
  void update(const BlockField& field);

  /// Number of blocks at the left and at the right, and at the top and at the bottom.
  int columns() const { return columns_.is_known() ? columns_.blocks : 0; }
  int rows() const { return rows_.is_known() ? rows_.blocks : 0; }

  /// Whether update() has found or lost bars: the film has another border than in the picture
  /// before.
  bool have_changed() const { return have_changed_; }

  /// Whether a block is outside of the film.
  bool contains(const BlockGrid& grid, size_t block) const {
    return grid.columns_beside(block) < columns() || grid.rows_beside(block) < rows();
  }

  void reset();

  /// In one or two pairs, an object may look like a bar.
  static constexpr int kKnownAfterPairs = 3;

 private:
  /// The bars on two opposite sides.
  struct Bars {
    int blocks = 0;
    int pairs = 0;  ///< of pictures that showed them
    /// Places along both edges that have changed since the bars have been there.
    std::array<std::vector<uint8_t>, 2> changed;

    bool is_known() const { return pairs >= kKnownAfterPairs; }
    void begin(int width);
  };

  static void look(Bars& bars, const BlockField& field, bool are_columns, int across);

  Bars columns_;
  Bars rows_;
  bool have_changed_ = false;
};

}  // namespace spidar
