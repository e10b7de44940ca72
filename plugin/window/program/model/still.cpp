// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/still.h"

#include <algorithm>
#include <array>

namespace spidar {

void shrink_into(Still& still, const uint8_t* rgba, int width, int height, int stride, int widest) {
  const int side = (width + widest - 1) / widest;
  // What is left of the last squares is left out, unless there are no others.
  still.width = std::max(width / side, 1);
  still.height = std::max(height / side, 1);
  const int across = std::min(side, width), down = std::min(side, height);
  const unsigned count = static_cast<unsigned>(across * down);
  still.rgba.resize(4 * static_cast<size_t>(still.width) * static_cast<size_t>(still.height));
  uint8_t* out = still.rgba.data();
  for (int y = 0; y < still.height; ++y) {
    for (int x = 0; x < still.width; ++x) {
      std::array<unsigned, 4> sum{};
      for (int dy = 0; dy < down; ++dy) {
        const uint8_t* in = rgba + static_cast<ptrdiff_t>(y * side + dy) * stride +
                            static_cast<ptrdiff_t>(4) * x * side;
        for (int i = 0; i < 4 * across; ++i) sum[static_cast<size_t>(i % 4)] += in[i];
      }
      for (const unsigned channel : sum)
        *out++ = static_cast<uint8_t>((channel + count / 2) / count);
    }
  }
}

}  // namespace spidar
