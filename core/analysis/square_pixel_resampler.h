// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/frame.h"
#include "core/picture/image_view.h"

namespace spidar {

/// Resamples pictures whose pixels are not square, as DVD, HDV and anamorphic HD store them. Motion
/// is measured in square pixels, because only there a rotation is a rotation, and directions and
/// speeds are those that a viewer sees. The pictures are resampled horizontally, so that the unit
/// of length remains the line spacing.
class SquarePixelResampler {
 public:
  /// Returns the picture resampled to square pixels, or `picture` itself if they are square.
  /// `pixel_aspect` > 0 is width over height of a pixel. The result is valid until the next call.
  /// Allocates only when the size changes.
  ImageView view(const ImageView& picture, double pixel_aspect);
  static int width_of(int stored_width, double pixel_aspect);

 private:
  std::vector<uint8_t> eight_bits_;
  std::vector<uint8_t> resampled_;
};

/// Converts `frame`, measured in the pixels of SquarePixelResampler, to those of the stored
/// picture, `width` pixels wide; and `area` of that picture to the pixels of a picture that is
/// `square_width` pixels wide.
void to_stored_pixels(Frame& frame, int width);
PicturePart in_square_pixels(const PicturePart& area, int width, int square_width);

}  // namespace spidar
