// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Puts pieces of an analysis together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/analysis/motion_file.h"

namespace spidar {

/// Pieces overlap. One ends and the next goes on at a cut in the film behind which both find the
/// same (CommonPast), so that the whole is what would have been measured at once, bit by bit. Where
/// both go on, that is verified.
class MotionJoin {
 public:
  /// Takes the pieces in their order. Throws MotionFileError, which says what is wrong, when it is
  /// not the next piece of the same analysis.
  void add(const MotionFile& piece);

  /// The whole file. Throws MotionFileError when pieces are missing, or do not continue each other.
  std::string whole() const;

 private:
  /// Rows that show the same frame.
  struct Place {
    size_t here = 0;
    size_t there = 0;
  };

  void check(const MotionHeader& next) const;
  std::optional<Place> find_join(const MotionFile& piece);
  bool is_same_from(const Place& place, const MotionFile& piece) const;
  std::string why_not_joined(const MotionFile& piece) const;
  void append(const MotionFile& piece, const Place& from);

  MotionHeader header_;
  int pieces_ = 0;
  std::vector<FrameRow> frames_;
  std::vector<std::vector<ObjectCode>> objects_;
  std::optional<int64_t> differs_ns_;  ///< where pieces that should agree do not
  std::string problem_;                ///< why a piece does not continue the one before
};

}  // namespace spidar
