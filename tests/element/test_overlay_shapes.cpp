// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Borders and marks that are drawn into the video: pixels are read back.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/canvas.h"

namespace spidar::test {
namespace {

TEST(Overlay, TheFeltArrowHasABorderOfOneWidthAllAround) {
  Canvas canvas("RGB", 641, 481);
  SceneView scene;
  scene.wrench.force_N = {0, 3, 0};
  canvas.draw(scene);
  // Up from (320, 240), 6 · 481 / 480 px wide, a fifth of 481 lines long. The head begins 4 widths
  // before the tip and is as wide there; the border is a quarter of a width.
  const double width_px = 6 * 481 / 480.0, margin_px = width_px / 4;
  const double tip_y = 240 - 481 / 5.0, neck_y = tip_y + 4 * width_px;
  const Pixel black{0, 0, 0}, white{255, 255, 255};
  // Beside the shaft: the head, its border, the picture.
  for (const int x : {312, 328}) {
    EXPECT_EQ(canvas.at(x, static_cast<int>(std::floor(neck_y))), white) << x;
    for (int y = static_cast<int>(std::ceil(neck_y)); y <= 180; ++y) {
      EXPECT_EQ(canvas.at(x, y), y <= neck_y + margin_px ? black : canvas.untouched())
          << "x " << x << ", " << y - neck_y << " px behind the head";
    }
  }
  // The sides lean by 1 in 2, so that along the arrow their border measures √5 times its width.
  const double along_px = std::sqrt(5.0) * margin_px;
  for (const int aside : {-4, -2, 2, 4}) {
    const double edge_y = tip_y + 2.0 * std::abs(aside);
    for (int y = static_cast<int>(edge_y) - 8; y < static_cast<int>(edge_y) + 3; ++y) {
      const Pixel expected = y >= edge_y              ? white
                             : y >= edge_y - along_px ? black
                                                      : canvas.untouched();
      EXPECT_EQ(canvas.at(320 + aside, y), expected) << aside << ", " << y - edge_y;
    }
  }
}

}  // namespace
}  // namespace spidar::test
