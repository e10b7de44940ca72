// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where a piece of an analysis may end.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/analysis/common_past.h"
#include "core/analysis/motion_file.h"

namespace spidar {

/// A film is divided into pieces of equal length. The run that measures one of them begins with its
/// first frame and goes on until the run of a later one can take over: until the second cut behind
/// which both find the same. What is between these cuts is compared by MotionJoin. A piece without
/// such cuts cannot take over: its run ends with it, and the one before goes on.
class PieceEnd {
 public:
  explicit PieceEnd(const MotionPiece& piece) : piece_(piece), part_(piece.number) {}

  /// The number of the piece to which a frame belongs.
  int part_of(int64_t stream_ns) const {
    const double share = static_cast<double>(stream_ns) / static_cast<double>(piece_.film_ns);
    return std::clamp(1 + static_cast<int>(share * piece_.of), 1, piece_.of);
  }

  /// Takes each frame that was measured. `agrees`: a run that began with the piece to which the
  /// frame belongs has found the same. True when no frame after it is needed.
  bool take(Shown shown, int64_t stream_ns, bool agrees) {
    const int part = part_of(stream_ns);
    if (part > part_) {
      if (is_empty()) return true;
      part_ = part;
      cuts_ = 0;
      past_.restart();
    }
    if (!agrees) {
      past_.restart();
      return false;
    }
    cuts_ += shown == Shown::kFirst && past_.is_enough();
    past_.add(shown, stream_ns, true);
    return part_ > piece_.number && cuts_ == kCuts;
  }

  /// Whether no run can go over to this one, as far as it has come.
  bool is_empty() const { return piece_.number > 1 && part_ == piece_.number && cuts_ < kCuts; }

 private:
  static constexpr int kCuts = 2;

  const MotionPiece piece_;
  int part_;
  int cuts_ = 0;
  CommonPast past_;
};

/// Stream time at which a piece begins.
inline int64_t begin_ns(const MotionPiece& piece) {
  const double share = static_cast<double>(piece.number - 1) / piece.of;
  return static_cast<int64_t>(share * static_cast<double>(piece.film_ns));
}

}  // namespace spidar
