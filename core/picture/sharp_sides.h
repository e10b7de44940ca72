// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds a film beside blurred copies of itself.
#pragma once

#include <optional>
#include <vector>

#include "core/picture/image_view.h"
#include "core/picture/picture_part.h"

namespace spidar {

/// For one thread at a time. Allocates only when the size changes.
class SharpSides {
 public:
  /// The part of a reduced picture of 8 bits that lies between two equally wide sides, left and
  /// right or above and below, which are blurred along all of their length, as television shows a
  /// film of an upright telephone. Sides that are plain are bars, which Margins leaves out. One
  /// picture suffices.
  std::optional<PicturePart> find(const ImageView& picture);

 private:
  struct Sums {
    int sharpness = 0;  ///< Σ |4 pixel − those around it|
    int grey = 0;
  };

  int side_width(const ImageView& picture, bool are_beside);
  void measure(const ImageView& picture, bool are_beside);
  Sums strip(int band, int from) const;
  float sharper(int inside, int outside);

  int length_ = 0;  ///< of a band
  int bands_ = 0;
  std::vector<Sums> sums_;  ///< cumulative sums along each band
  std::vector<float> ratios_;
};

}  // namespace spidar
