// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interlaced pictures that nobody has flagged.
#pragma once

#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/image_view.h"

namespace spidar {

/// Share of pixels that show combs: what moved between two fields jumps there and back from line to
/// line. Of every sixteen lines four are looked at, of pixels those that differ by kComb_grey from
/// the line above and the one below and hardly from the next but one.
SPIDAR_API double comb_share(const ImageView& frame, std::vector<uint8_t>& lines);
namespace plain {
SPIDAR_API double comb_share(const ImageView& frame, std::vector<uint8_t>& lines);
}

/// Tells from the frames so far whether a film is interlaced, or telecined, though it says that it
/// is not. In such a film one field is to be looked at, as the two fields are two moments. Fine
/// stripes look the same; of these one field loses some sharpness and nothing else.
class SPIDAR_API Combing {
 public:
  /// Looks at the next frame, and says whether to take a single field of it. Large frames need no
  /// answer, as the analysis takes the lines of one field of them in any case (row_step()).
  bool see(const ImageView& frame);

 private:
  int frames_left_ = 0;  ///< for which it is still taken for interlaced
  std::vector<uint8_t> lines_;
};

}  // namespace spidar
