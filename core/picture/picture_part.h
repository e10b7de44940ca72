// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/picture/image_view.h"

namespace spidar {

/// A rectangle of a picture, px.
struct PicturePart {
  int x = 0, y = 0, width = 0, height = 0;

  bool operator==(const PicturePart& other) const {
    return x == other.x && y == other.y && width == other.width && height == other.height;
  }
  bool operator!=(const PicturePart& other) const { return !(*this == other); }
};

/// `part` lies inside the picture.
inline ImageView part_of(const ImageView& picture, const PicturePart& part) {
  return {picture.at(part.x, part.y), part.width, part.height, picture.stride_bytes,
          picture.sample};
}

}  // namespace spidar
