// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"

namespace spidar::test {

/// A grey picture that owns its memory: `width` × `height` pixels in rows `stride` bytes apart. The
/// bytes between rows are not 0, so that a test notices when they are read.
struct Picture {
  Picture(int width_px, int height_px, int padding = 0)
      : width(width_px),
        height(height_px),
        stride(width_px + padding),
        pixels(static_cast<size_t>(stride) * static_cast<size_t>(height), 0xAA) {}

  uint8_t& at(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(stride) + static_cast<size_t>(x)];
  }

  /// Sets each pixel to grey(x, y), a level 0 … 255 at the pixel's centre.
  template <typename Grey>
  void fill(Grey&& grey) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        at(x, y) =
            static_cast<uint8_t>(std::lround(grey(static_cast<double>(x), static_cast<double>(y))));
      }
    }
  }

  ImageView view() const { return {pixels.data(), width, height, stride}; }

  int width;
  int height;
  int stride;
  std::vector<uint8_t> pixels;
};

}  // namespace spidar::test
