// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the strongest corner in part of a picture (Shi–Tomasi, eq. 1).
#pragma once

#include "core/tracking/padded_image.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Centre of a window of kCornerWindow_px and its corner strength.
struct Corner {
  ImagePoint at;
  /// Smaller eigenvalue of the mean structure tensor of the window, with the mean gradient
  /// subtracted, (grey / px)²; 0 if the window is flat or contains only an edge.
  float strength = 0;
};

/// Side of the window in eq. 1, equal to that of the tracked windows.
constexpr int kCornerWindow_px = 8;
/// Spacing of the candidate windows.
constexpr int kCornerStep_px = 4;

/// Minimum ratio of the smaller to the larger eigenvalue. A window with a lower ratio shows an
/// edge, and a match along the edge would only follow noise.
constexpr float kLeastRoundness = 0.05f;

/// A rectangle of an image in pixels; x1, y1 are exclusive.
struct PixelBox {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
};

/// Largest side of the rectangle that best_corner() searches, px.
constexpr int kMostCornerBox_px = 64;

/// Returns the strongest window inside `box` on a grid of kCornerStep_px that starts at its upper
/// left corner, among those with at least kLeastRoundness. Derivatives are central differences.
/// `box` must lie inside the image. A box smaller than a window has no corner.
Corner best_corner(const PaddedImage& image, const PixelBox& box);

}  // namespace spidar
