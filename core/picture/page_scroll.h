// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/picture/image_view.h"

namespace spidar {

/// Distinguishes a page that scrolls from a camera that moves. A page scrolls up or down by whole
/// pixels, and its content stays the same to the last bit, while the noise of a camera changes
/// moving content. A few patches therefore suffice: a page scrolls when all changed patches in some
/// columns or rows are found again, unchanged and as far away, and have rested or scrolled before.
/// A cartoon without noise that keeps panning up or down by whole pixels counts as a page. For one
/// thread at a time; does not allocate.
class PageScroll {
 public:
  /// Whether the picture is the previous one scrolled; false for another size or format.
  bool update(const ImageView& picture);
  void reset() { width_ = 0; }

  static constexpr int kPatch_bytes = 16;

 private:
  static constexpr int kAcross = 8, kDown = 8;
  using Cells = std::array<int, size_t{kAcross} * kDown>;
  /// kPatch_bytes of two neighbouring lines, from `x` on.
  struct Patch {
    int x = 0, y = 0;
    bool has_detail = false;  ///< the lines differ, and one of them is not plain
    std::array<uint8_t, kPatch_bytes> upper, lower;
  };

  bool compare(const ImageView& picture);
  void store(const ImageView& picture);

  int width_ = 0, height_ = 0;
  int bytes_ = 0;  ///< of a pixel
  std::array<Patch, size_t{kAcross} * kDown> patches_;
  /// For how many pictures each patch has not changed, or has only scrolled; at most kRests.
  Cells rests_;
};

}  // namespace spidar
