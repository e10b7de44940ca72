// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// From pictures to a wrench: a textured square moves to the right over a textured background, 4 px
// in each of 25 pictures a second; prints the wanted wrench. Needs only libgst-spidar: g++
// -std=c++17 picture.cpp $(pkg-config --cflags --libs gst-spidar)
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <gst-spidar/motion.h>

namespace {

constexpr int kWidth = 320, kHeight = 240, kSide = 96;

/// A random grey that depends only on the position, in spots of 3 × 3 pixels.
std::uint8_t texture(int x, int y, unsigned seed) {
  const unsigned spot = static_cast<unsigned>(x / 3 * 73 + y / 3 * 151) + seed;
  return static_cast<std::uint8_t>((spot * 2654435761u) >> 24);
}

}  // namespace

int main() {
  gst_spidar::MotionToWrench motion;
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (int frame = 0; frame < 20; ++frame) {
    const int left = 40 + 4 * frame, top = 72;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool on = x >= left && x < left + kSide && y >= top && y < top + kSide;
        pixels[y * kWidth + x] = on ? texture(x - left, y - top, 7) : texture(x, y, 0);
      }
    const auto found = motion.analyze({pixels.data(), kWidth, kHeight, kWidth},
                                      std::chrono::milliseconds(40 * frame));
    std::printf("%.1f px/s to the right: %.2f N\n", found.velocity_x_px_s, found.wrench.force_N.x);
  }
}
