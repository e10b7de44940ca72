// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/margins.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Largest fraction of the picture on one side, to the nearest line: that of a film of 4:3 in a
/// picture of 16:9; 2.35:1 in 16:9 has a little less. With more, a large box in front of a still
/// scene without noise would pass for a film in a frame.
constexpr double kMostOfSide = (1 - (4 / 3.0) / (16 / 9.0)) / 2;

/// Fraction of the positions along the edge of a film that change while a bar beside them does not:
/// the rest may be plain or dark.
constexpr double kChangedFraction = 0.8;

/// The rows, or the columns, of blocks as seen from one side of the picture.
struct Side {
  const BlockField& field;
  bool are_columns;
  bool from_end;  ///< line 0 is the last row or column
  int across;     ///< blocks at both ends of a line that do not count

  int lines() const { return are_columns ? field.grid().columns : field.grid().rows; }
  int positions() const { return are_columns ? field.grid().rows : field.grid().columns; }

  bool has_changed(int line, int position) const {
    if (from_end) line = lines() - 1 - line;
    const size_t block =
        are_columns ? field.grid().index(line, position) : field.grid().index(position, line);
    const auto difference = static_cast<float>(field.difference_if_moved(block, {0, 0}));
    return difference > kRounding_grey * kBlockArea_px;
  }

  bool stands(int line) const {
    for (int position = across; position < positions() - across; ++position) {
      if (has_changed(line, position)) return false;
    }
    return true;
  }

  /// How many lines stand, from the side on; 0 when it is more than a bar.
  int standing() const {
    const auto most = static_cast<int>(std::lround(kMostOfSide * lines()));
    int n = 0;
    while (n <= most && stands(n)) ++n;
    return n > most ? 0 : n;
  }

  /// Adds the positions where the first line that does not stand, or the next one, has changed: the
  /// edge is anywhere in the first one. Returns whether they are nearly all.
  bool is_edge(int line, std::vector<uint8_t>& changed) const {
    int all = 0;
    for (int position = across; position < positions() - across; ++position) {
      uint8_t& mark = changed[static_cast<size_t>(position)];
      if (mark == 0) mark = has_changed(line, position) || has_changed(line + 1, position);
      all += mark;
    }
    return all >= kChangedFraction * (positions() - 2 * across);
  }
};

}  // namespace

void Margins::Bars::begin(int width) {
  blocks = width;
  pairs = 0;
  for (auto& positions : changed) std::fill(positions.begin(), positions.end(), uint8_t{0});
}

void Margins::look(Bars& bars, const BlockField& field, bool are_columns, int across) {
  const Side first{field, are_columns, false, across};
  const Side last{field, are_columns, true, across};
  const int at_first = first.standing();
  const int at_last = at_first == 0 ? 0 : last.standing();
  const int fewer = std::min(at_first, at_last);
  const int blocks = std::max(at_first, at_last) + 1;
  const bool alike = fewer > 0 && blocks <= fewer + 2;
  if (bars.is_known() && fewer + 2 >= bars.blocks) return;
  if (!alike) return bars.begin(0);
  if (bars.is_known() || bars.blocks == 0 || blocks < bars.blocks) bars.begin(blocks);
  for (auto& positions : bars.changed) positions.resize(static_cast<size_t>(first.positions()));
  const int edge = bars.blocks - 1;
  const bool begins = first.is_edge(edge, bars.changed[0]);
  const bool ends = last.is_edge(edge, bars.changed[1]);
  bars.pairs += begins && ends;
}

void Margins::update(const BlockField& field) {
  const int rows_before = rows();
  const int columns_before = columns();
  look(rows_, field, false, columns());
  look(columns_, field, true, rows());
  have_changed_ = rows() != rows_before || columns() != columns_before;
}

void Margins::reset() {
  rows_.begin(0);
  columns_.begin(0);
  have_changed_ = false;
}

}  // namespace spidar
