// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"

namespace spidar {

/// The fraction of pixels that show combs: what moved between two fields jumps back and forth from
/// line to line. Of every sixteen lines, four are examined. A pixel counts if it differs by
/// kComb_grey from the lines above and below and hardly from the line after those.
double comb_fraction(const ImageView& frame, std::vector<uint8_t>& lines);

/// Detects from the frames so far whether a film is interlaced or telecined although it is not
/// flagged. Only one field of such a film should be analysed, because its two fields show different
/// moments. Fine stripes look the same; a film with such stripes only loses some sharpness.
class Combing {
 public:
  /// Examines the next frame and returns whether to take only one field of it. Returns false for
  /// large frames, of which the analysis reads only one field anyway (row_step()).
  bool update(const ImageView& frame);

 private:
  int frames_left_ = 0;  ///< for which the film still counts as interlaced
  std::vector<uint8_t> lines_;
};

}  // namespace spidar
