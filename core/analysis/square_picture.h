// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pictures whose pixels are not square, as DVD, HDV and anamorphic HD store them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/frame_analysis.h"
#include "core/image_view.h"

namespace spidar {

/// Motion is measured in square pixels, because only there a rotation is a rotation, and a
/// direction and a speed are those that a viewer sees. The pictures are resampled along their
/// lines, so that the unit of all lengths remains the distance of two lines.
class SquarePicture {
 public:
  /// The picture as if its pixels were square; `picture` itself where they are. `pixel_aspect` > 0
  /// is width over height of a pixel. Valid until the next call. Allocates only when the size
  /// changes.
  ImageView view(const ImageView& picture, double pixel_aspect);

 private:
  std::vector<uint8_t> eight_bits_;
  std::vector<uint8_t> resampled_;
};

/// The result for a picture of square pixels, in pixels of the picture as it is stored.
class StoredPixels {
 public:
  /// Changes `analysis`, of a SquarePicture, to that of the picture itself, which is `width` pixels
  /// wide. What it points to is valid until the next call.
  void convert(FrameAnalysis& analysis, int width);

 private:
  std::vector<Track> tracks_;
  Background background_;
  std::vector<MovingObject> objects_;
};

}  // namespace spidar
